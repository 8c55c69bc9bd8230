#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "common/config/rig_file.h"
#include "tests/helpers/paths.h"
#include "tools/simulation/builtin_motion.h"
#include "tools/simulation/load_motion.h"
#include "tools/simulation/motion_speed.h"
#include "tools/simulation/place_in_room.h"
#include "tools/simulation/room.h"

namespace evit::simulation {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Rig TestRig() {
  Rig rig;
  rig.T_body_camera = {ExpSO3(Eigen::Vector3d(1.1, -1.3, 1.2)), Eigen::Vector3d(0.13, 0.08, 0.02)};
  return rig;
}

Motion Builtin(const std::string& name, double duration, std::uint64_t variant = 1) {
  MotionSettings settings;
  settings.source = "builtin:" + name;
  settings.duration_s = duration;
  settings.variant = variant;
  return LoadMotion(settings, TestRig());
}

// Amplitude of one axis of the translation (mm) and of the rotation (rad) at a frequency, of a motion against
// another one.
double Amplitude(const PoseSpline& shaken, const PoseSpline& calm, double hz, int axis, bool rotation) {
  std::complex<double> sum = 0;
  int n = 0;
  const Utime begin = calm.begin() + 200'000, end = calm.end() - 200'000;
  for (Utime t = begin; t < end; t += 2'000, ++n) {
    const SE3 d = calm.Pose(t).Inverse() * shaken.Pose(t);
    const double value = rotation ? LogSO3(d.q)[axis] : 1e3 * d.p[axis];
    sum += value * std::polar(1.0, -6.283185307179586 * hz * ToSeconds(t - begin));
  }
  return 2 * std::abs(sum) / n;
}

// The default variant is the motion as it always was: a few poses of it, as printed before there were
// variants.
TEST(BuiltinMotion, FirstVariantStaysWhatItWas) {
  const Rig rig = TestRig();
  for (const auto& [name, row] :
       std::map<std::string, const char*>{{"handheld",
                                           "1642661139.500000 0.138466509 0.108745867 -0.0976602324 "
                                           "0.498842212 -0.484582872 0.477723932 0.536764131"},
                                          {"fast",
                                           "1642661139.500000 -0.020962343 0.112659232 -0.126903589 "
                                           "0.337582882 -0.508112802 0.496609266 0.61744507"}}) {
    const Trajectory poses = MakeBuiltinMotion(*FindBuiltinMotion(name), 2, 1, rig);
    EXPECT_EQ(TumLine(poses[300]), row) << name;
  }
}

TEST(Carry, MovesOnSmoothlyAndStaysThere) {
  Trajectory poses = MakeBuiltinMotion(*FindBuiltinMotion("robot_normal"), 4, 1, TestRig());
  const Trajectory before = poses;
  const Utime begin = poses.front().t;
  CarryAway({1, 2.5, 1.5, -0.5, 2}, begin, &poses);
  SE3 a, b, end_a, end_b;
  ASSERT_TRUE(PoseAt(before, begin + 900'000, &a) && PoseAt(poses, begin + 900'000, &b));
  EXPECT_EQ(a.p, b.p);
  EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
  ASSERT_TRUE(PoseAt(before, begin + 1'000'000, &a));
  for (const Utime t : {2'600'000, 3'900'000}) {
    ASSERT_TRUE(PoseAt(before, begin + t, &end_a) && PoseAt(poses, begin + t, &end_b));
    const Eigen::Quaterniond turn = ExpSO3({0, 0, 2});
    EXPECT_LT(AngularDistance(end_b.q, turn * end_a.q), 1e-9);
    EXPECT_LT((end_b.p - (a.p + turn * (end_a.p - a.p) + Eigen::Vector3d(1.5, -0.5, 0))).norm(), 0.005);
  }
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double dt = ToSeconds(poses[k].t - poses[k - 1].t);
    EXPECT_LT((poses[k].pose.p - poses[k - 1].pose.p).norm() / dt, 4);  // m/s: nothing jumps
  }
}

TEST(BuiltinMotion, HasTheSpeedsOfItsNameAndStaysInTheRoom) {
  const Rig rig = TestRig();
  const Scene scene = MakeRoom(1);
  for (const char* kind : {"desk", "sofa", "robot"}) {
    for (const bool fast : {false, true}) {
      for (std::uint64_t variant = 1; variant <= 10; ++variant) {
        const std::string name = std::string(kind) + (fast ? "_fast" : "_normal");
        Motion motion = Builtin(name, 6, variant);
        ASSERT_NO_THROW(PlaceInRoom(rig, scene, &motion)) << name << ' ' << variant;
        const MotionSpeed speed = MeasureMotionSpeed(motion, rig);
        EXPECT_GT(speed.mean, fast ? 0.45 : 0.09) << name << ' ' << variant;
        EXPECT_LT(speed.mean, fast ? 0.95 : 0.26) << name << ' ' << variant;
        EXPECT_GT(speed.turn_mean, fast ? 1.1 : 0.25) << name << ' ' << variant;
        EXPECT_LT(speed.turn_mean, fast ? 1.8 : 0.6) << name << ' ' << variant;
        for (Utime t = motion.begin; t <= motion.end; t += 50'000) {
          const Eigen::Vector3d camera = (motion.spline.Pose(t) * rig.T_body_camera).p;
          EXPECT_LT(scene.free_space.exteriorDistance(camera), 0.02) << name << ' ' << variant;
        }
      }
    }
  }
}

TEST(BuiltinMotion, DeskLooksDownAtTheDesk) {
  const Rig rig = TestRig();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene scene = MakeRoom(seed);
    Motion motion = Builtin("desk_normal", 6, seed);
    PlaceInRoom(rig, scene, &motion);
    double distance = 0, sight = 0;
    int n = 0;
    for (Utime t = motion.begin; t <= motion.end; t += 50'000, ++n) {
      const SE3 T_map_camera = motion.spline.Pose(t) * rig.T_body_camera;
      const Eigen::Vector3d to_desk = scene.desk - T_map_camera.p;
      distance += to_desk.norm();
      sight += (T_map_camera.q * Eigen::Vector3d::UnitZ()).dot(to_desk.normalized());
    }
    EXPECT_NEAR(distance / n, 1.05, 0.35) << seed;
    EXPECT_GT(sight / n, 0.85) << seed;
  }
}

TEST(PlaceInRoom, SaysHowItMovedThePath) {
  const Rig rig = TestRig();
  const Scene scene = MakeRoom(1);
  for (const char* name : {"handheld", "desk_normal"}) {
    const Motion original = Builtin(name, 3, 1);
    Motion placed = original;
    // As of a file in another frame.
    placed.spline = placed.spline.Moved({ExpSO3(Eigen::Vector3d(0, 0, 1)), Eigen::Vector3d(7, -3, 1)});
    const SE3 before = placed.spline.Pose(placed.begin);
    PlaceInRoom(rig, scene, &placed);
    const SE3 expected = placed.T_map_source * before, after = placed.spline.Pose(placed.begin);
    EXPECT_LT((expected.p - after.p).norm(), 1e-9) << name;
    EXPECT_LT(AngularDistance(expected.q, after.q), 1e-9) << name;
    EXPECT_LT(LogSO3(placed.T_map_source.q).head<2>().norm(), 1e-9) << name << ": z stays up";
  }
}

TEST(BuiltinMotion, RotationHardlyMoves) {
  for (std::uint64_t variant = 1; variant <= 5; ++variant) {
    const Motion motion = Builtin("rotation", 6, variant);
    const Rig rig = TestRig();
    Eigen::AlignedBox3d box;
    for (Utime t = motion.begin; t <= motion.end; t += 20'000) {
      box.extend((motion.spline.Pose(t) * rig.T_body_camera).p);
    }
    EXPECT_LT(box.sizes().maxCoeff(), 0.25) << variant;
    EXPECT_NEAR(MeasureMotionSpeed(motion, rig).turn_mean, 1, 0.2) << variant;
  }
}

TEST(BuiltinMotion, VariantsDiffer) {
  std::set<double> seen;
  for (std::uint64_t variant = 1; variant <= 10; ++variant) {
    seen.insert(Builtin("handheld", 2, variant).spline.Pose(1'642'661'139'000'000).p.x());
  }
  EXPECT_EQ(seen.size(), 10U);
}

// At three times the speed the same poses come in a third of the time, and turn rates are three times as
// high.
TEST(PlaySpeed, IsTheSameWayInLessTime) {
  const Motion slow = Builtin("handheld", 6);
  Trajectory poses;
  for (Utime t = slow.begin - 300'000; t <= slow.end + 300'000; t += 8'333)
    poses.push_back({t, slow.spline.Pose(t)});
  const fs::path path = fs::temp_directory_path() / ("evit_motion_test_" + std::to_string(getpid()) + ".tum");
  WriteTum(path.string(), poses);
  MotionSettings settings;
  settings.source = path.string();
  settings.frame = TrajectoryFrame::kBody;
  settings.begin_s = 1.5;  // of the file's time
  settings.end_s = 5.4;
  settings.play_speed = 3;
  const Motion quick = LoadMotion(settings, TestRig());
  fs::remove(path);
  EXPECT_NEAR(ToSeconds(quick.end - quick.begin), 1.3, 1e-3);
  for (double s = 0; s < 1.3; s += 0.1) {
    const auto a = slow.spline.Evaluate(poses.front().t + static_cast<Utime>((1.5 + 3 * s) * 1e6));
    const auto b = quick.spline.Evaluate(quick.begin + static_cast<Utime>(s * 1e6));
    EXPECT_LT((a.pose.p - b.pose.p).norm(), 1e-4) << s;
    EXPECT_LT(AngularDistance(a.pose.q, b.pose.q), 3e-4) << s;
    EXPECT_LT((3 * a.rate - b.rate).norm(), 0.02) << s;
  }
  settings.play_speed = 0;
  EXPECT_THROW(LoadMotion(settings, TestRig()), std::runtime_error);
}

// 7 Hz comes through the spline in full, and nothing of it is elsewhere.
TEST(TremorOfAHand, SurvivesTheSpline) {
  const Motion calm = Builtin("robot_normal", 20);
  const Tremor tremor{7, 7, 1.1};
  const PoseSpline shaken = AddTremor(calm.spline, tremor, 0.033, 1);
  double translation = 0, rotation = 0;
  int n = 0;
  for (Utime t = calm.begin; t < calm.end; t += 3'000, ++n) {
    const SE3 d = calm.spline.Pose(t).Inverse() * shaken.Pose(t);
    translation += d.p.squaredNorm();
    rotation += LogSO3(d.q).squaredNorm();
  }
  EXPECT_NEAR(1e3 * std::sqrt(2 * translation / n), 7, 0.35);
  EXPECT_NEAR(57.29578 * std::sqrt(2 * rotation / n), 1.1, 0.055);
  for (int axis = 0; axis < 3; ++axis) {
    double band = 0;
    for (double hz = 5.5; hz < 8.5; hz += 0.05)
      band = std::max(band, Amplitude(shaken, calm.spline, hz, axis, false));
    EXPECT_GT(band, 0.7) << axis;
    for (const double hz : {1.0, 3.0, 12.0, 20.0})
      EXPECT_LT(Amplitude(shaken, calm.spline, hz, axis, false), 0.08 * band) << axis << ' ' << hz;
  }
  // Seeded.
  const Utime t = calm.begin + 1'234'567;
  EXPECT_EQ(AddTremor(calm.spline, tremor, 0.033, 1).Pose(t).p, shaken.Pose(t).p);
  EXPECT_GT((AddTremor(calm.spline, tremor, 0.033, 2).Pose(t).p - shaken.Pose(t).p).norm(), 1e-5);
}

TEST(TremorOfAHand, IsInTheMotionThatIsLoaded) {
  MotionSettings settings;
  settings.source = "builtin:robot_normal";
  settings.duration_s = 3;
  const MotionSpeed calm = MeasureMotionSpeed(LoadMotion(settings, TestRig()), TestRig());
  settings.tremor = {7, 7, 1.1};
  const MotionSpeed shaken = MeasureMotionSpeed(LoadMotion(settings, TestRig()), TestRig());
  EXPECT_GT(shaken.turn_mean, calm.turn_mean + 0.2);  // 1.1 degrees at 7 Hz: up to 0.84 rad/s
  settings.tremor.hz = 100;
  EXPECT_THROW(LoadMotion(settings, TestRig()), std::runtime_error);
}

// A marker body somewhere else than the IMU.
Rig MarkerRig() {
  Rig rig = TestRig();
  rig.T_marker_body = {ExpSO3(Eigen::Vector3d(-0.4, 0.9, 2)), Eigen::Vector3d(0.07, 0, -0.09)};
  return rig;
}

TEST(LoadMotion, SaysWhatANameMayHaveMeant) {
  const auto said = [](const std::string& source) -> std::string {
    MotionSettings settings;
    settings.source = source;
    try {
      LoadMotion(settings, TestRig());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(said("handheld").find("did you mean builtin:handheld?"), std::string::npos) << said("handheld");
  EXPECT_NE(said("builtin:handhelt").find("no such motion"), std::string::npos);
  EXPECT_NE(said("none.tum").find("no such file"), std::string::npos);
  EXPECT_NE(said("/tmp").find("is a folder"), std::string::npos);
}

TEST(LoadMotion, DetectsMarkerPoses) {
  const Rig rig = MarkerRig();
  MotionSettings settings;
  settings.source = "builtin:handheld";
  settings.duration_s = 2;
  const Motion body = LoadMotion(settings, rig);
  const SE3 T_yup_zup(ExpSO3(Eigen::Vector3d(-1.5707963267948966, 0, 0)), Eigen::Vector3d::Zero());
  Trajectory raw;
  for (Utime t = body.begin; t < body.end; t += 8333) {
    raw.push_back({t, T_yup_zup * body.spline.Pose(t) * rig.T_marker_body.Inverse()});
  }
  const fs::path path = fs::temp_directory_path() / ("evit_raw_" + std::to_string(getpid()) + ".tum");
  WriteTum(path.string(), raw);
  settings.source = path.string();
  const Motion again = LoadMotion(settings, rig);
  fs::remove(path);
  EXPECT_THAT(again.note, HasSubstr("poses read as marker-yup"));
  const Utime t = body.begin + 1'000'000;
  EXPECT_LT((again.spline.Pose(t).p - body.spline.Pose(t).p).norm(), 1e-4);
  EXPECT_LT(AngularDistance(again.spline.Pose(t).q, body.spline.Pose(t).q), 1e-3);
}

// The recordings themselves, and what is simulated from them.
TEST(LoadMotion, DetectsTheFrameOfRealFiles) {
  const fs::path folder = test::RecordingsPath("vector/groundtruth");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here; set EVIT_SHARED_DATA";
  const Rig rig = LoadRig(test::SourcePath("config/vector/rig.textproto"));
  const Scene scene = MakeRoom(1);
  for (const char* name : {"robot_normal", "mountain_normal", "sofa_fast"}) {
    MotionSettings settings;
    settings.source = (folder / (std::string(name) + ".txt")).string();
    settings.begin_s = 5;
    settings.end_s = 15;
    Motion motion = LoadMotion(settings, rig);
    EXPECT_THAT(motion.note, HasSubstr("poses read as marker-yup")) << name;
    PlaceInRoom(rig, scene, &motion);
    Trajectory body;
    for (Utime t = motion.begin; t < motion.end; t += 5000) body.push_back({t, motion.spline.Pose(t)});
    const fs::path path = fs::temp_directory_path() / ("evit_body_" + std::to_string(getpid()) + ".tum");
    WriteTum(path.string(), body);
    settings.source = path.string();
    settings.begin_s = settings.end_s = 0;
    EXPECT_THAT(LoadMotion(settings, rig).note, HasSubstr("poses read as body")) << name;
    fs::remove(path);
  }
}

}  // namespace
}  // namespace evit::simulation
