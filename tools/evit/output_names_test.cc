#include "tools/evit/output_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/helpers/temporary_folder.h"

namespace evit::commands {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class OutputNames : public ::testing::Test {
 protected:
  static void Refuses(const std::string& path, const std::string& why) {
    EXPECT_THAT([&] { RequireOutput("--out", path); },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("--out " + path), HasSubstr(why))));
  }
  static void RefusesFolder(const std::string& path, const std::string& why) {
    EXPECT_THAT([&] { RequireOutputFolder("--out", path); },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("--out " + path), HasSubstr(why))));
  }
  std::ptrdiff_t Entries() const {
    return std::distance(fs::directory_iterator(fs::path(folder_.File("x")).parent_path()), {});
  }

  const TemporaryFolder folder_{"output_names"};
};

TEST_F(OutputNames, AFileNeedsAFolderThatTakesIt) {
  RequireOutput("--out", folder_.File("map.pcd"));
  RequireOutput("--out", "");
  EXPECT_EQ(Entries(), 0);  // the trial is gone
  Refuses(folder_.File("none/map.pcd"), "mkdir -p");
  Refuses("/proc/map.pcd", "nothing can be written to /proc");  // whoever asks
  Refuses(fs::path(folder_.File("x")).parent_path().string(), "is a folder");
  Refuses("/dev/null", "is a device");
  std::ofstream(folder_.File("file")) << "x";
  RequireOutput("--out", folder_.File("file"));
  Refuses(folder_.File("file/map.pcd"), "is a file, not a folder");
}

TEST_F(OutputNames, AFolderIsThereOrCanBeMade) {
  RequireOutputFolder("--out", folder_.File("a/b/c"));
  RequireOutputFolder("--out", fs::path(folder_.File("x")).parent_path().string());
  RequireOutputFolder("--out", "");
  EXPECT_EQ(Entries(), 0);
  RefusesFolder("/proc/result", "nothing can be written to /proc");
  std::ofstream(folder_.File("file")) << "x";
  RefusesFolder(folder_.File("file"), "is a file, a folder is needed");
  RefusesFolder(folder_.File("file/b"), "is a file, a folder is needed");
}

TEST_F(OutputNames, ALinkIsFollowed) {
  fs::create_symlink("/proc/map.pcd", folder_.File("link"));
  Refuses(folder_.File("link"), "nothing can be written to /proc");
}

TEST_F(OutputNames, NoOutputIsAFileThatIsReadOrWrittenToo) {
  const std::string scan = folder_.File("scan.pcd"), other = folder_.File("other.pcd");
  std::ofstream(scan) << "x";
  EXPECT_THROW(RequireNotAnInput("--out", folder_.File("./scan.pcd"), {scan}), std::runtime_error);
  EXPECT_THROW(RequireNotAnInput("--out", folder_.File("./other.pcd"), {scan, other}), std::runtime_error);
  RequireNotAnInput("--out", other, {scan, ""});
  RequireNotAnInput("--out", "", {""});
}

}  // namespace
}  // namespace evit::commands
