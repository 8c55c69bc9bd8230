// `evit map check` on a recording whose map, rig or poses are wrong in one way each: named, with the remedy.
#include <gmock/gmock.h>

#include <functional>

#include "tests/helpers/painted_pictures.h"
#include "tests/helpers/run_evit.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::commands {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class MapCheckTest : public testing::Test {
 protected:
  std::string File(const std::string& name) const { return folder_.File(name); }
  static std::string Sample(const std::string& name) { return test::SourcePath("logs/" + name); }

  // What is said where one of the inputs is another than the sample's.
  std::string Check(const std::string& map, const std::string& rig, const std::string& truth,
                    int code = 0) const {
    const test::ProgramOutcome outcome =
        test::RunEvit("map check --log " + Sample("sample.lcmlog") + " --map " + map + " --rig " + rig +
                      " --truth " + truth);
    EXPECT_EQ(outcome.code, code) << outcome.output;
    return outcome.output;
  }
  std::string CheckMap(const std::string& transform, int code) const {
    const test::ProgramOutcome made =
        test::RunEvit("map " + transform + " " + Sample("sample_map.pcd") + " --out " + File("map.pcd"));
    EXPECT_EQ(made.code, 0) << made.output;
    return Check(File("map.pcd"), Sample("rig.textproto"), Sample("sample_truth.tum"), code);
  }
  std::string CheckRig(const std::function<void(Rig*)>& change) const {
    Rig rig = LoadRig(Sample("rig.textproto"));
    change(&rig);
    WriteRig(File("rig.textproto"), rig, "wrong", "");
    return Check(Sample("sample_map.pcd"), File("rig.textproto"), Sample("sample_truth.tum"), 3);
  }

 private:
  TemporaryFolder folder_{"map_check"};
};

TEST_F(MapCheckTest, SaysNothingWhereAllIsRight) {
  const std::string text =
      Check(Sample("sample_map.pcd"), Sample("rig.textproto"), Sample("sample_truth.tum"));
  EXPECT_THAT(text, AllOf(HasSubstr("nothing looks wrong"), Not(HasSubstr("warning:"))));
  EXPECT_THAT(text, Not(HasSubstr(" ms late"))) << "an offset that changes nothing is none";
}

TEST_F(MapCheckTest, NamesAMapOfAnotherFrameOrScale) {
  EXPECT_THAT(CheckMap("transform --transform '1 0 0 0.1 0 1 0 -0.06 0 0 1 0.05 0 0 0 1'", 3),
              AllOf(HasSubstr("warning: poses shifted by"),
                    HasSubstr("evit map transform --transform \"1 0 0 -0.0")));
  EXPECT_THAT(CheckMap("transform --scale 1.05", 3), AllOf(HasSubstr("too small for the map: corrected"),
                                                           HasSubstr("evit map transform --scale 0.95")));
  EXPECT_THAT(CheckMap("transform --transform '1 0 0 0 0 0 -1 0 0 1 0 0 0 0 0 1'", 2),
              AllOf(HasSubstr("almost nothing to do with each other"), HasSubstr("is y up in the map")));
}

// Points that lie on nothing of this room, right where the camera looks.
TEST_F(MapCheckTest, AnotherRoomsMapIsAnError) {
  const PointMap own = LoadMap(Sample("sample_map.pcd")).map;
  PointMap other;
  for (std::size_t k = 0; k < own.points.size(); ++k) {
    // The room seen in a mirror, shifted by half its width: edges of the same kind elsewhere.
    const Eigen::Vector3f& p = own.points[k];
    other.points.emplace_back(p.x() + 0.31F, p.y() - 0.23F, 2.4F - p.z());
  }
  WriteMap(File("other.pcd"), other);
  EXPECT_THAT(Check(File("other.pcd"), Sample("rig.textproto"), Sample("sample_truth.tum"), 2),
              AllOf(HasSubstr("error: map and events have almost nothing"), HasSubstr("another room's map")));
}

// By accident a few points may lie on events; they explain none of what fires.
TEST_F(MapCheckTest, AMapWithHardlyAnythingInViewIsAnError) {
  const PointMap own = LoadMap(Sample("sample_map.pcd")).map;
  PointMap corner;
  for (const Eigen::Vector3f& p : own.points) {
    if ((p - own.points.front()).norm() < 0.25F) corner.points.push_back(p);
  }
  WriteMap(File("corner.pcd"), corner);
  EXPECT_THAT(Check(File("corner.pcd"), Sample("rig.textproto"), Sample("sample_truth.tum"), 2),
              HasSubstr("error: "));
}

TEST_F(MapCheckTest, NamesAMapWithHoles) {
  EXPECT_THAT(CheckMap("crop --box :,:,1.2:", 3),
              AllOf(HasSubstr("it has holes"), HasSubstr("evit map merge")));
}

TEST_F(MapCheckTest, NamesATimeOffsetAndWrongExtrinsicsAndIntrinsics) {
  EXPECT_THAT(CheckRig([](Rig* rig) { rig->camera_time_offset += 30'000; }),
              AllOf(HasSubstr("warning: events "), HasSubstr(" ms late: corrected"),
                    HasSubstr("to camera.time_offset_us of")));
  EXPECT_THAT(CheckRig([](Rig* rig) {
                rig->T_body_camera.q = rig->T_body_camera.q * ExpSO3({0, 0.035, 0});
              }),
              AllOf(HasSubstr("warning: camera turned by 2.0"), HasSubstr("evit calibrate finds it")));
  EXPECT_THAT(CheckRig([](Rig* rig) { rig->camera.fx = rig->camera.fy = 175; }),
              AllOf(HasSubstr("warning: focal length 6."), HasSubstr("fx and fy of")));
}

// Map and poses lie alike, and both askew: only gravity tells, and the command that is named mends it.
TEST_F(MapCheckTest, NamesAMapThatIsNotUprightAndMendsIt) {
  const SE3 askew(ExpSO3({0.14, 0.05, 0}), Eigen::Vector3d::Zero());
  PointMap map = LoadMap(Sample("sample_map.pcd")).map;
  for (Eigen::Vector3f& p : map.points) p = (askew * p.cast<double>()).cast<float>();
  WriteMap(File("askew.pcd"), map);
  Trajectory truth = ReadTum(Sample("sample_truth.tum"));
  for (StampedPose& pose : truth) pose.pose = askew * pose.pose;
  WriteTum(File("askew.tum"), truth);
  const std::string log = Sample("sample.lcmlog");
  EXPECT_THAT(Check(File("askew.pcd"), Sample("rig.textproto"), File("askew.tum"), 3),
              AllOf(HasSubstr("warning: gravity is 8."),
                    HasSubstr("evit map transform --upright " + log + " --truth " + File("askew.tum"))));

  const test::ProgramOutcome turned = test::RunEvit(
      "map transform " + File("askew.pcd") + " --upright " + log + " --truth " + File("askew.tum") +
      " --out " + File("upright.pcd") + " --truth-out " + File("upright.tum"));
  ASSERT_EQ(turned.code, 0) << turned.output;
  EXPECT_THAT(turned.output, HasSubstr("--T-map-world"));
  EXPECT_THAT(Check(File("upright.pcd"), Sample("rig.textproto"), File("upright.tum")),
              HasSubstr("nothing looks wrong"));
  const test::ProgramOutcome alone =
      test::RunEvit("map transform " + File("askew.pcd") + " --upright " + log + " --out " + File("a.pcd"));
  EXPECT_NE(alone.code, 0);
  EXPECT_THAT(alone.output, HasSubstr("--truth"));
}

}  // namespace
}  // namespace evit::commands
