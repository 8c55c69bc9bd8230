#include "common/config/settings_text.h"

#include "common/config/option_table.h"
#include "tests/helpers/config_files.h"

namespace evit {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Method = PipelineOptions::Method;

class SettingsTextTest : public test::ConfigFilesTest {};

// A value of every option that differs from its default and is allowed.
SettingValue Other(const std::string& path, const SettingValue& usual) {
  if (const auto* flag = std::get_if<bool>(&usual)) return !*flag;
  if (const auto* real = std::get_if<double>(&usual))
    return path == "keyframes.fixed_rate_hz" ? 30 : *real == 0 ? 0.03 : *real * 0.97;
  const std::int64_t whole = std::get<std::int64_t>(usual);
  return whole == 0 ? std::int64_t{1} : whole <= 2 ? whole - 1 : whole + 1;
}

TEST_F(SettingsTextTest, WhatIsWrittenLoadsToTheSameOptions) {
  for (const Method method : {Method::kEvit, Method::kEvt, Method::kEvpt}) {
    PipelineOptions options = DefaultsOf(method);
    std::string text = SettingsText(options);
    for (const std::string& path : OptionPaths()) {
      const std::string name = path.substr(0, path.find('.'));
      const bool other_method = (name == "evit" && method != Method::kEvit) ||
                                (name == "evt" && method != Method::kEvt) ||
                                (name == "evpt" && method != Method::kEvpt);
      if (other_method) continue;
      SetOption(path, Other(path, GetOption(options, path)), &options);
      const std::string changed = SettingsText(options);
      EXPECT_NE(changed, text) << path << " is not in the file";
      text = changed;
    }
    EXPECT_EQ(SettingsText(LoadOptions(Write("all.textproto", text))), text);
    const std::string short_one = SettingsText(options, ShowKind::kChanges);
    EXPECT_EQ(SettingsText(LoadOptions(Write("changes.textproto", short_one))), text);
  }
}

TEST_F(SettingsTextTest, CommentsTellUnitMeaningAndOrigin) {
  const std::string path = Write("a.textproto", "\n\nsurface { lookahead_ms: 10 }");
  const std::string text = CommentedSettings(LoadSettings(path));
  EXPECT_THAT(text, HasSubstr("  lookahead_ms: 10 "));
  EXPECT_THAT(text, HasSubstr("# 0 to 200 ms: SYMMETRIC: how far events after the stamp count"));
  EXPECT_THAT(text, HasSubstr("[" + path + ":3; default 40]"));
  EXPECT_THAT(text, HasSubstr("  n_event: 8000"));
  EXPECT_THAT(text, HasSubstr("since the last keyframe, at least [default]"));
  EXPECT_THAT(text, Not(HasSubstr("evpt")));
  EXPECT_EQ(SettingsText(LoadOptions(Write("b.textproto", text))), SettingsText(LoadOptions(path)));
}

TEST_F(SettingsTextTest, MarkdownHasEveryKeyOfEveryMethod) {
  const std::string text = SettingsMarkdown();
  for (const std::string& path : OptionPaths()) {
    EXPECT_THAT(text, HasSubstr("\n| `" + path.substr(path.rfind('.') + 1) + "` | ")) << path;
    EXPECT_THAT(text, HasSubstr("### " + path.substr(0, path.rfind('.')) + "\n")) << path;
  }
  EXPECT_THAT(text, Not(HasSubstr("photometric.")));
}

}  // namespace
}  // namespace evit
