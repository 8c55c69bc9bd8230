#include "common/files/made_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/helpers/temporary_folder.h"

namespace evit {
namespace {

namespace fs = std::filesystem;

void Make(const std::string& path) {
  fs::create_directories(path);
  std::ofstream(path + "/result") << "x";
}

TEST(MadeFolder, GoesWithTheParentsThatWereMissing) {
  const TemporaryFolder folder("made");
  for (const char* end : {"", "/"}) {
    const std::string path = folder.File("a/b/c");
    const MadeFolder made(path + end);
    Make(path);
    EXPECT_TRUE(made.Remove());
    EXPECT_FALSE(fs::exists(folder.File("a")));
    EXPECT_TRUE(fs::exists(folder.File(".")));
  }
}

TEST(MadeFolder, ThatWasThereBeforeStays) {
  const TemporaryFolder folder("made");
  Make(folder.File("a"));
  const MadeFolder made(folder.File("a"));
  EXPECT_FALSE(made.Remove());
  EXPECT_TRUE(fs::exists(folder.File("a/result")));
}

TEST(MadeFolder, ParentsWithSomethingElseInThemStay) {
  const TemporaryFolder folder("made");
  const MadeFolder made(folder.File("a/b/c"));
  Make(folder.File("a/b/c"));
  Make(folder.File("a/other"));
  EXPECT_TRUE(made.Remove());
  EXPECT_FALSE(fs::exists(folder.File("a/b")));
  EXPECT_TRUE(fs::exists(folder.File("a/other/result")));
  EXPECT_FALSE(made.Remove());
}

}  // namespace
}  // namespace evit
