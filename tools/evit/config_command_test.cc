// `evit config`, the program.

#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "tests/helpers/config_files.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/run_evit.h"

namespace evit::commands {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Result = test::ProgramOutcome;

Result Config(const std::string& arguments) { return test::RunEvit("config " + arguments); }

class ConfigCommand : public test::ConfigFilesTest {};

TEST_F(ConfigCommand, ShowsTheDefaultsAsAFileThatLoads) {
  const Result result = Config("show");
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_EQ(SettingsText(LoadOptions(Write("shown.textproto", result.output))),
            SettingsText(PipelineOptions()));
}

TEST_F(ConfigCommand, ShowsWhereAValueWasSet) {
  const std::string path = Write("a.textproto", "evit {\n  window { size: 8 }\n}\n");
  EXPECT_THAT(Config("show " + path).output, HasSubstr(path + ":2; default 5]"));
  EXPECT_THAT(Config("show --markdown").output, HasSubstr("| `size` | `5` | 2 to 50 keyframes |"));
}

TEST_F(ConfigCommand, CheckAcceptsGoodFilesAndNamesTheFaultOfOthers) {
  EXPECT_EQ(Config("check " + Write("good.textproto", "evt { }")).code, 0);
  const Result result = Config("check " + Write("bad.textproto", "evt { }\npoint { }"));
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.output, HasSubstr("bad.textproto:2:1: point: no such key; did you mean points?"));
  EXPECT_EQ(Config("check --rig " + test::SourcePath("logs/rig.textproto")).code, 0);
  EXPECT_EQ(Config("check").code, 1);
}

// A copy of the sample's rig with a part of its camera changed.
std::string Changed(const std::string& from, const std::string& to) {
  std::ifstream file(test::SourcePath("logs/rig.textproto"));
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(ConfigCommand, CheckWarnsOfIntrinsicsOfAnotherResolution) {
  EXPECT_THAT(Config("check --rig " + test::SourcePath("logs/rig.textproto")).output, HasSubstr(": good"));
  const std::string half =
      Write("half.textproto",
            Changed("width: 320                     # pixels\n  height: 240", "width: 160\n  height: 120"));
  const Result result = Config("check --rig " + half);
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.output, AllOf(HasSubstr("half.textproto: warning"), HasSubstr("principal point"),
                                   Not(HasSubstr("good"))));
  const std::string metres = Write("metres.textproto", Changed("fx: 163.663745", "fx: 0.327"));
  EXPECT_THAT(Config("check --rig " + metres).output, HasSubstr("look at fx"));
}

// The same twentieth as an import; what is left is no log.
TEST_F(ConfigCommand, FeedRefusesASizeThatDropsManyEvents) {
  const std::string feed =
      "feed --from " + test::SourcePath("logs/sample.lcmlog") + " --out " + Path("fed.lcmlog");
  const Result half = test::RunEvit(feed + " --size 160x120");
  EXPECT_EQ(half.code, 1);
  EXPECT_THAT(half.output, AllOf(HasSubstr("outside the sensor"), HasSubstr("more than 5 %")));
  EXPECT_FALSE(std::filesystem::exists(Path("fed.lcmlog")));
  EXPECT_EQ(test::RunEvit(feed + " --size 320x240").code, 0);
  EXPECT_TRUE(std::filesystem::exists(Path("fed.lcmlog")));
}

TEST_F(ConfigCommand, NamesKeysOfEarlierVersions) {
  const Result result = Config("check " + Write("old.textproto", "method: EVIT\nwindow { size: 4 }"));
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.output, HasSubstr("old.textproto:2: window.size is now evit.window.size"));
}

}  // namespace
}  // namespace evit::commands
