#include "common/files/staged_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

namespace evit {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class StagedFileTest : public ::testing::Test {
 protected:
  StagedFileTest() : folder_(fs::temp_directory_path() / ("staged_file_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~StagedFileTest() override { fs::remove_all(folder_); }

  std::string Path(const char* name) const { return (folder_ / name).string(); }
  static void Write(const std::string& path, const char* text) { std::ofstream(path) << text; }
  static std::string Text(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  fs::path folder_;
};

TEST_F(StagedFileTest, TheExtensionStaysWhereAskedFor) {
  EXPECT_EQ(StagedFile(Path("a.png"), StagedFile::Name::kPartExtension).part(), Path("a.png.part.png"));
  EXPECT_EQ(StagedFile(Path("a.png")).part(), Path("a.png.part"));
}

TEST_F(StagedFileTest, ASymbolicLinkStaysAndWhatItPointsAtIsReplaced) {
  fs::create_directory(folder_ / "disk");
  fs::create_symlink("disk/big", folder_ / "link");
  {
    StagedFile file(Path("link"));
    Write(file.part(), "new");
    file.Commit();
  }
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(Text(Path("disk/big")), "new");
}

TEST_F(StagedFileTest, APipeIsNotReplaced) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  StagedFile file(Path("pipe"));
  Write(file.part(), "new");
  EXPECT_THAT([&] { file.Commit(); },
              ThrowsMessage<std::runtime_error>(HasSubstr("not a file that can be replaced")));
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
}

// In a process of its own; the exit by the signal is what a shell sees.
TEST_F(StagedFileTest, ASignalRemovesWhatIsStagedAndEndsTheProgram) {
  Write(Path("kept"), "old");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      std::signal(signal, SIG_DFL);  // a background shell may ignore it
      RemoveStagedFilesOnSignals();
      const StagedDirectory made(Path("made"));
      const StagedFile inside(Path("made/file")), beside(Path("kept"));
      Write(inside.part(), "half");
      Write(beside.part(), "half");
      raise(signal);
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    EXPECT_FALSE(fs::exists(Path("made"))) << signal;
    EXPECT_FALSE(fs::exists(Path("kept.part"))) << signal;
    EXPECT_EQ(Text(Path("kept")), "old");
  }
}

TEST_F(StagedFileTest, AFolderIsKeptOnlyWithContentsOrIfItWasThere) {
  { const StagedDirectory empty(Path("empty")); }
  EXPECT_FALSE(fs::exists(Path("empty")));
  {
    const StagedDirectory full(Path("full"));
    Write(Path("full/file"), "x");
  }
  EXPECT_TRUE(fs::exists(Path("full/file")));
  fs::create_directory(folder_ / "there");
  { const StagedDirectory there(Path("there")); }
  EXPECT_TRUE(fs::exists(Path("there")));
  Write(Path("file"), "x");
  EXPECT_THROW(StagedDirectory(Path("file")), std::runtime_error);
}

}  // namespace
}  // namespace evit
