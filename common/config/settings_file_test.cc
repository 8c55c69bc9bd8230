// Settings files: what they set, what they are based on, and how faults are named.
#include "common/config/settings_file.h"

#include <filesystem>

#include "common/config/settings_text.h"
#include "tests/helpers/config_files.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

using test::Edited;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kConfig = test::SourcePath("config/");
const std::string kEarlier = test::SourcePath("common/config/testdata/");

class SettingsFile : public test::ConfigFilesTest {
 protected:
  PipelineOptions Load(const std::string& text) { return LoadOptions(Write("a.textproto", text)); }
  // Expects that a file with this text is refused.
  void ExpectTextRefused(const std::string& text, const std::string& place,
                         const std::vector<std::string>& words) {
    ExpectRefused(LoadOptions, Write("a.textproto", text), place, words);
  }
};

TEST_F(SettingsFile, ShippedTrackerIsTheDefaults) {
  EXPECT_EQ(SettingsText(LoadOptions(kConfig + "tracker.textproto")), SettingsText(PipelineOptions()));
}

TEST_F(SettingsFile, NoFileAndAnEmptyFileAreTheDefaults) {
  EXPECT_EQ(SettingsText(LoadOptions("")), SettingsText(PipelineOptions()));
  EXPECT_EQ(SettingsText(Load("")), SettingsText(PipelineOptions()));
}

TEST_F(SettingsFile, ShippedBaselinesDifferInAFewValues) {
  const PipelineOptions evt = LoadOptions(kConfig + "evt.textproto");
  EXPECT_EQ(evt.method, PipelineOptions::Method::kEvt);
  EXPECT_EQ(evt.keyframes.fixed_rate_hz, 300);
  EXPECT_EQ(evt.window.motion_model, WindowOptions::MotionModel::kConstantVelocity);
  PipelineOptions papers = LoadOptions(kConfig + "evt_paper.textproto");
  EXPECT_EQ(papers.window.motion_model, WindowOptions::MotionModel::kPreviousPose);
  papers.window.motion_model = evt.window.motion_model;
  EXPECT_EQ(SettingsText(papers), SettingsText(evt));
  const PipelineOptions evpt = LoadOptions(kConfig + "evpt.textproto");
  EXPECT_EQ(evpt.method, PipelineOptions::Method::kEvpt);
  EXPECT_EQ(evpt.keyframes.n_event, 20'000);
}

TEST_F(SettingsFile, SetsOnlyWhatItSays) {
  const PipelineOptions options = Load("evit { window { size: 8 } }\nsurface { kind: CAUSAL }");
  EXPECT_EQ(options.window.size, 8);
  EXPECT_EQ(options.surface.kind, SurfaceOptions::Kind::kCausal);
  EXPECT_EQ(SettingsText(options, ShowKind::kChanges),
            "surface {\n  kind: CAUSAL\n}\nevit {\n  window {\n    size: 8\n  }\n}\n");
}

// As they were shipped with version 0.1.
TEST_F(SettingsFile, FullCopiesOfEarlierVersionsLoadToTheSameValues) {
  for (const auto& [name, now] : {std::pair("tracker", "tracker"), std::pair("evt", "evt_paper")}) {
    const LoadedSettings earlier = LoadSettings(kEarlier + name + "_0.1.textproto");
    PipelineOptions expected = LoadOptions(kConfig + now + ".textproto");
    expected.keyframes.n_event = 30'000;  // what has another default since
    expected.keyframes.min_events = 2000;
    expected.surface.blur_sigma_px = 0.5;
    expected.points.max_active = 5000;
    expected.points.margin_px = 40;
    expected.points.per_keyframe = 1500;
    expected.window.image_sigma = 80;
    expected.failure.min_contrast = 0.03;
    expected.bootstrap.min_contrast = 0.06;
    expected.bootstrap.max_duration_s = 2;
    expected.window.correlated_share = 1.8;
    expected.window.map_sigma_m = 0.0012;
    EXPECT_EQ(SettingsText(earlier.options), SettingsText(expected));
    EXPECT_THAT(earlier.notes, Contains(HasSubstr("window.kernel is now alignment.kernel")));
    EXPECT_THAT(earlier.notes, Contains(HasSubstr("surface.split_polarity has no effect any more")));
  }
  const PipelineOptions evpt = LoadOptions(kEarlier + "evpt_0.1.textproto");
  EXPECT_EQ(evpt.method, PipelineOptions::Method::kEvpt);
  EXPECT_EQ(evpt.keyframes.n_event, 20'000);
  const std::string changed =
      Edited(test::ReadText(kEarlier + "evpt_0.1.textproto"), "levels: 2", "levels: 3");
  EXPECT_EQ(Load(changed).photometric.levels, 3);
}

TEST_F(SettingsFile, EarlierKeysSetTheirNewPlaces) {
  const PipelineOptions options =
      Load("method: EVIT window { size: 7 motion_model: 1 robust_scale: 50 } failure { min_contrast: 0.02 }");
  EXPECT_EQ(options.window.size, 7);
  EXPECT_EQ(options.window.motion_model, WindowOptions::MotionModel::kConstantVelocity);
  EXPECT_EQ(options.window.robust_scale, 50);
  EXPECT_EQ(options.failure.min_contrast, 0.02);
  EXPECT_EQ(Load("method: EVT window { motion_model: CONSTANT_VELOCITY }").window.motion_model,
            WindowOptions::MotionModel::kConstantVelocity);
  ExpectTextRefused("window {\n  size: 1\n}", ":2", {"evit.window.size", "2 to 50 keyframes"});
}

TEST_F(SettingsFile, StartsFromItsBase) {
  Write("base.textproto", "evit { window { size: 8 max_iterations: 20 } }\npoints { seed: 3 }");
  std::filesystem::create_directories(Path("deeper"));
  Write("deeper/middle.textproto", "base: \"../base.textproto\"\nevit { window { size: 9 } }");
  const LoadedSettings loaded =
      LoadSettings(Write("top.textproto", "base: \"deeper/middle.textproto\"\npoints { per_keyframe: 800 }"));
  EXPECT_EQ(loaded.options.window.size, 9);
  EXPECT_EQ(loaded.options.window.max_iterations, 20);
  EXPECT_EQ(loaded.options.points.seed, 3);
  EXPECT_EQ(loaded.options.points.per_keyframe, 800);
  EXPECT_EQ(loaded.set.at("evit.window.size").Place(), Path("deeper/middle.textproto") + ":2");
}

TEST_F(SettingsFile, AnotherMethodThanTheBasesDropsItsPart) {
  Write("base.textproto", "evit { motion_model: IMU window { size: 8 } } points { seed: 3 }");
  const PipelineOptions options = Load("base: \"base.textproto\" evt { }");
  EXPECT_EQ(options.method, PipelineOptions::Method::kEvt);
  EXPECT_EQ(options.points.seed, 3);
  EXPECT_EQ(SettingsText(options, ShowKind::kChanges), "points {\n  seed: 3\n}\nevt { }\n");
}

TEST_F(SettingsFile, FilesBasedOnEachOtherAreNamed) {
  const std::string a = Write("a.textproto", "base: \"b.textproto\"");
  const std::string b = Write("b.textproto", "\nbase: \"a.textproto\"");
  try {
    LoadOptions(a);
    ADD_FAILURE() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("files are based on each other: " + a + " -> " + b + " -> " + a));
  }
}

TEST_F(SettingsFile, ChainsOfBasesHaveALimit) {
  for (int k = 0; k < 9; ++k)
    Write(std::to_string(k) + ".textproto", "base: \"" + std::to_string(k + 1) + ".textproto\"");
  Write("8.textproto", "");
  EXPECT_THROW(LoadOptions(Path("0.textproto")), ConfigError);
  EXPECT_NO_THROW(LoadOptions(Path("1.textproto")));
}

TEST_F(SettingsFile, ABaseThatIsNotThereIsNamedWithItsLine) {
  ExpectTextRefused("# start\nbase: \"nowhere.textproto\"", ":2",
                    {"base", "nowhere.textproto", "cannot be read"});
  ExpectTextRefused("base: \"/\"", ":1", {"cannot be read"});
}

TEST_F(SettingsFile, UnknownKeysAreNamedWithTheNearestOne) {
  ExpectTextRefused("evit {\n  window {\n    sice: 4 } }", ":3:5", {"did you mean evit.window.size?"});
  ExpectTextRefused("surface { }\n  robust_scale: 4", ":2:3", {"did you mean alignment.robust_scale?"});
  ExpectTextRefused("surfaces { }", ":1:1", {"did you mean surface?"});
  ExpectTextRefused("evt { window { } }", ":1:7", {"evt.window", "did you mean evit.window?"});
  ExpectTextRefused("zzzzzzzzzz: 1", ":1:1", {"zzzzzzzzzz", "known here: base, keyframes"});
}

TEST_F(SettingsFile, RemovedKeysSayWhatToDo) {
  ExpectTextRefused("surface {\n  split_polarity: true\n}", ":2",
                    {"surface.split_polarity: was removed", "delete the line"});
  EXPECT_THAT(LoadSettings(Write("a.textproto", "surface { split_polarity: false }")).notes,
              ElementsAre(HasSubstr("split_polarity has no effect any more")));
}

TEST_F(SettingsFile, WrongTypesAreNamedWithWhatIsAllowed) {
  ExpectTextRefused("evit { window {\n size: five } }", ":2:2", {"evit.window.size", "2 to 50 keyframes"});
  ExpectTextRefused("surface { kind: ACAUSAL\n lag_px: 0 }", ":1:11",
                    {"surface.kind", "ACAUSAL", "CAUSAL or SYMMETRIC"});
  ExpectTextRefused("points { occlusion: 3 }", ":1:10", {"points.occlusion", "true or false"});
  ExpectTextRefused("keyframes { n_event: 99999999999 }", ":1:13", {"keyframes.n_event", "1 or more events"});
  ExpectTextRefused("evit { motion_model: 3 }", ":1:8",
                    {"evit.motion_model", "PREVIOUS_POSE, CONSTANT_VELOCITY or IMU"});
}

TEST_F(SettingsFile, DoubleKeysAndMissingBracesAreNamed) {
  ExpectTextRefused("points { seed: 3\n seed: 4 }", ":2:2", {"points.seed: is there twice"});
  ExpectTextRefused("points {\n seed: 3\n", ":2:2", {"a } is missing"});
}

TEST_F(SettingsFile, ValuesOutOfRangeAreNamedWithTheirLine) {
  ExpectTextRefused("alignment {\n  image_sigma: 0\n}", ":2",
                    {"alignment.image_sigma", "above 0 grey levels"});
  ExpectTextRefused("evit { window { size: 1 } }", ":1",
                    {"evit.window.size", "1 is out of range", "2 to 50 keyframes"});
  ExpectTextRefused("surface { truncation: 255 }", ":1", {"0 to below 255 grey levels"});
  ExpectTextRefused("surface { tail_px: inf }", ":1", {"surface.tail_px", "inf"});
  ExpectTextRefused("surface { tail_px: nan }", ":1", {"surface.tail_px", "nan"});
}

TEST_F(SettingsFile, ValuesAtOddsWithEachOtherAreNamedWithTheirPlaces) {
  ExpectTextRefused(
      "surface { min_decay_ms: 20 }", "",
      {"surface.min_decay_ms = 20", "a.textproto:1", "surface.default_decay_ms = 15 (default)"});
  ExpectTextRefused("points { min_depth_m: 12 }", "", {"points.min_depth_m", "below points.max_depth_m"});
}

TEST_F(SettingsFile, TwoMethodsAreOneTooMany) {
  ExpectTextRefused("evit { }\nevt { }", ":2:1", {"evt: cannot be there beside evit"});
}

TEST_F(SettingsFile, DefaultsFollowAWiderSensor) {
  Camera camera;
  camera.width = 1280, camera.height = 720;
  const PipelineOptions plain = LoadOptions(""), wide = LoadOptionsFor(camera, "");
  EXPECT_EQ(wide.keyframes.n_event, 2 * plain.keyframes.n_event);
  EXPECT_DOUBLE_EQ(wide.points.margin_px, 2 * plain.points.margin_px);
  EXPECT_EQ(wide.points.per_keyframe, plain.points.per_keyframe);
  const PipelineOptions set =
      LoadOptionsFor(camera, Write("a.textproto", "keyframes { n_event: 9000 } points { margin_px: 50 }"));
  EXPECT_EQ(set.keyframes.n_event, 9000);
  EXPECT_DOUBLE_EQ(set.points.margin_px, 50);
  camera.width = 240, camera.height = 180;
  EXPECT_EQ(LoadOptionsFor(camera, "").keyframes.n_event, plain.keyframes.n_event);
  EXPECT_EQ(LoadOptionsFor(camera, "").points.per_keyframe, plain.points.per_keyframe / 2);
  camera.width = 480, camera.height = 360;
  EXPECT_EQ(LoadOptionsFor(camera, "").points.per_keyframe, plain.points.per_keyframe * 3 / 4);
  EXPECT_EQ(LoadOptionsFor(camera, Write("b.textproto", "points { per_keyframe: 900 }")).points.per_keyframe,
            900);
}

TEST_F(SettingsFile, AFileThatIsNotThereIsNamed) {
  ExpectRefused(LoadOptions, "/nonexistent/tracker.textproto", "", {"cannot be read"});
  EXPECT_THROW(LoadOptions(kConfig), ConfigError) << "a folder";
}

}  // namespace
}  // namespace evit
