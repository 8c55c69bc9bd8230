#include "common/service/mapped_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>

namespace evit {
namespace {

struct Record {
  std::int64_t a = 0;
  double b[100] = {};
};

class MappedFileTest : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  std::string path_ = ::testing::TempDir() + "evit_mapped_" + std::to_string(::getpid());
};

TEST_F(MappedFileTest, ComesBackAndBelongsToItsIdentity) {
  {
    MappedRecord<Record> file(path_, 7);
    EXPECT_FALSE(file.Load());
    for (std::int64_t k = 1; k <= 3; ++k) file.Store({k, {0.5}});
    EXPECT_EQ(file.Load()->a, 3);
  }
  EXPECT_EQ(MappedRecord<Record>(path_, 7).Load()->a, 3);
  EXPECT_EQ(MappedRecord<Record>(path_, 7).Load()->b[0], 0.5);
  EXPECT_FALSE(MappedRecord<std::int64_t>(path_, 7).Load());  // another size
  MappedRecord<Record>(path_, 7).Store({4, {}});
  EXPECT_FALSE(MappedRecord<Record>(path_, 8).Load());
  EXPECT_FALSE(MappedRecord<Record>(path_, 7).Load());  // the other identity has taken the file
}

TEST_F(MappedFileTest, ForeignFilesAreTakenOver) {
  for (const std::string& text : {std::string("x"), std::string(100'000, 'y')}) {
    std::ofstream(path_) << text;
    MappedRecord<Record> file(path_, 1);
    EXPECT_FALSE(file.Load());
    file.Store({1, {}});
    EXPECT_EQ(file.Load()->a, 1);
  }
}

// Killed in the middle of storing, again and again: what is there is always whole.
TEST_F(MappedFileTest, IsWholeWhateverTheMomentOfDeath) {
  for (int round = 0; round < 20; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      MappedRecord<Record> file(path_, 1);
      Record record;
      for (;;) {
        ++record.a;
        for (double& b : record.b) b = static_cast<double>(record.a);
        file.Store(record);
      }
    }
    usleep(3000);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const auto record = MappedRecord<Record>(path_, 1).Load();
    if (!record) continue;
    for (const double b : record->b) ASSERT_EQ(b, static_cast<double>(record->a));
  }
}

TEST_F(MappedFileTest, AnUnwritableFileIsNamed) {
  EXPECT_THROW(MappedRecord<Record>("/nonexistent/folder/file", 1), std::runtime_error);
}

}  // namespace
}  // namespace evit
