// `evit config`, the program.

#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "tests/helpers/config_files.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/run_evit.h"

namespace evit::commands {
namespace {

using ::testing::HasSubstr;

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

TEST_F(ConfigCommand, NamesKeysOfEarlierVersions) {
  const Result result = Config("check " + Write("old.textproto", "method: EVIT\nwindow { size: 4 }"));
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.output, HasSubstr("old.textproto:2: window.size is now evit.window.size"));
}

}  // namespace
}  // namespace evit::commands
