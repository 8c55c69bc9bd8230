#include "tools/monitor/page_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/temporary_folder.h"

namespace evit::monitor {
namespace {

using ::testing::HasSubstr;

constexpr char kCommand[] = "scripts/build release monitor_page";

TEST(PageFiles, APageThatWasNotBuiltSaysWhichCommandBuildsIt) {
  const TemporaryFolder folder("page_files");
  const std::vector<WebFile> files = LoadPage(folder.File(""));
  ASSERT_EQ(files.size(), 1U);
  EXPECT_THAT(files[0].content, HasSubstr(kCommand));
  EXPECT_THAT(MissingPage(folder.File("")), HasSubstr(kCommand));
}

TEST(PageFiles, APageThatWasBuiltIsServedAndNeedsNoWarning) {
  const TemporaryFolder folder("page_files");
  folder.Write("index.html", "the page");
  const std::vector<WebFile> files = LoadPage(folder.File(""));
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].content, "the page");
  EXPECT_EQ(MissingPage(folder.File("")), "");
}

}  // namespace
}  // namespace evit::monitor
