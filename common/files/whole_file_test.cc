#include "common/files/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <stdexcept>

namespace evit {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class WholeFileTest : public ::testing::Test {
 protected:
  WholeFileTest()
      : path_(std::filesystem::temp_directory_path() / ("whole_file_" + std::to_string(getpid()))) {}
  ~WholeFileTest() override { std::filesystem::remove(path_); }

  std::string Text() const {
    std::ifstream file(path_);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::string Part() const { return path_.string() + ".part"; }

  std::filesystem::path path_;
};

TEST_F(WholeFileTest, AppearsOnlyWithCommit) {
  WholeFile file(path_);
  file.stream() << "new";
  EXPECT_FALSE(std::filesystem::exists(path_));
  file.Commit();
  EXPECT_EQ(Text(), "new");
  EXPECT_FALSE(std::filesystem::exists(Part()));
}

TEST_F(WholeFileTest, AbandonedWriteKeepsTheEarlierVersion) {
  std::ofstream(path_) << "old";
  { WholeFile(path_).stream() << "new"; }
  EXPECT_EQ(Text(), "old");
  EXPECT_FALSE(std::filesystem::exists(Part()));
}

TEST_F(WholeFileTest, CommitNamesAFileThatCannotBeWritten) {
  WholeFile file("/nowhere/file.txt");
  EXPECT_THAT([&] { file.Commit(); }, ThrowsMessage<std::runtime_error>(HasSubstr("/nowhere/file.txt")));
}

}  // namespace
}  // namespace evit
