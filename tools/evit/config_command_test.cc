// `evit config`, the program.
#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "tests/helpers/config_files.h"
#include "tests/helpers/paths.h"

namespace evit::commands {
namespace {

using ::testing::HasSubstr;

struct Result {
  int code;
  std::string output;  // both streams
};

Result Config(const std::string& arguments) {
  std::FILE* pipe = ::popen((test::ProgramPath("evit") + " config " + arguments + " 2>&1").c_str(), "r");
  Result result{-1, ""};
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    result.output.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
  return result;
}

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

TEST_F(ConfigCommand, ChecksFiles) {
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
