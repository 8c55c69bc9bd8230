#include "tools/paper/paper_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/config/config_error.h"
#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "tests/helpers/paper.h"
#include "tests/helpers/paths.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class PaperConfig : public ::testing::Test {
 protected:
  // The shipped configuration with one text in place of another.
  std::string Changed(const std::string& from, const std::string& to) {
    std::string text = ReadText(test::SourcePath("config/paper.textproto"));
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return folder_.Write("paper.textproto", text.replace(at, from.size(), to));
  }
  void ExpectError(const std::string& from, const std::string& to, const std::string& what) {
    const std::string path = Changed(from, to);
    EXPECT_THAT([&] { LoadPaper(path); }, ThrowsMessage<ConfigError>(AllOf(HasSubstr(path), HasSubstr(what))))
        << to;
  }
  TestFolder folder_{"paper_config"};
};

TEST_F(PaperConfig, ShippedOneHasThePapersSequencesAndMethods) {
  const paper::Paper config = ShippedPaper();
  for (const paper::Method& method : config.method())
    EXPECT_EQ(std::filesystem::path(method.config()).filename() == "evt_paper.textproto",
              method.name() == "EVT")
        << method.id();
  ASSERT_EQ(config.sequence_size(), 6);
  EXPECT_EQ(config.sequence(0).name(), "sofa_normal");
  EXPECT_GE(config.method_size(), 4);
  EXPECT_EQ(config.motion_model_size(), 3);
  for (const paper::Method& m : AllMethods(config)) EXPECT_FALSE(TrackerText(m).empty()) << m.id();
  EXPECT_EQ(AllMethods(config).size(), static_cast<std::size_t>(config.method_size()) + 2)
      << "evit is in both lists";
}

TEST_F(PaperConfig, ErrorsNameFileAndKey) {
  ExpectError("seeds: 3", "seedz: 3", "seedz");
  ExpectError("seeds: 3", "", "seeds");
  ExpectError("seeds: 3", "seeds: 0", "seeds: 0 is out of range; allowed: 1 to 99");
  ExpectError("simulated_s: 10", "simulated_s: 1", "simulated_s");
  ExpectError("id: \"evt100\"", "id: \"evt300\"", "\"evt300\" is there twice");
  ExpectError("id: \"evt100\"", "id: \"evt/100\"", "not a file name");
  ExpectError("fixed_rate_hz: 100", "fixed_rate_hz: 5000", "fixed_rate_hz");
  ExpectError("motion_model: CONSTANT_VELOCITY", "motion_model: 3",
              "PREVIOUS_POSE, CONSTANT_VELOCITY or IMU");
  ExpectError("name: \"sofa_normal\"", "name: \"robot_normal\"", "sequence robot_normal: is there twice");
  ExpectError("figure_sequence: \"sofa_fast\"", "figure_sequence: \"nowhere\"", "nowhere");
  ExpectError("scene: \"sofa\"", "scene: \"sofa\" begin_s: 3", "begin_s and end_s");
  ExpectError("scene: \"sofa\"", "scene: \"sofa\" begin_s: 3 end_s: 2", "begin_s < end_s");
  ExpectError("scene: \"sofa\"", "scene: \"sofa\" T_map_world: [1, 2]", "16 numbers");
  ExpectError("id: \"evit\" name: \"second-order\"", "id: \"evt30\" name: \"second-order\"",
              "differs from the method of that id");
}

TEST_F(PaperConfig, MethodsChangeOnlyWhatTheySay) {
  paper::Method method;
  method.set_config(test::SourcePath("config/tracker.textproto"));
  const std::string plain = TrackerText(method);
  method.set_fixed_rate_hz(30);
  method.set_motion_model(config::Evit::CONSTANT_VELOCITY);
  PipelineOptions changed = LoadOptions(folder_.Write("changed.textproto", TrackerText(method)));
  EXPECT_EQ(changed.keyframes.fixed_rate_hz, 30);
  EXPECT_EQ(changed.window.motion_model, WindowOptions::MotionModel::kConstantVelocity);
  changed.keyframes.fixed_rate_hz = 0;
  changed.window.motion_model = WindowOptions::MotionModel::kImu;
  EXPECT_EQ(SettingsText(changed), plain);
}

TEST_F(PaperConfig, MotionModelsAreForEvit) {
  paper::Method method;
  method.set_config(test::SourcePath("config/evt.textproto"));
  method.set_motion_model(config::Evit::IMU);
  EXPECT_THROW(TrackerText(method), ConfigError);
}

}  // namespace
}  // namespace evit::paper
