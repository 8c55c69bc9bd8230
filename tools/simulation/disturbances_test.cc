#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/simulation/edge_map.h"
#include "tools/simulation/event_stage.h"
#include "tools/simulation/load_motion.h"
#include "tools/simulation/moving_box.h"
#include "tools/simulation/place_in_room.h"
#include "tools/simulation/room.h"

namespace evit::simulation {
namespace {

Rig SmallRig() {
  Rig rig;
  rig.camera.width = 160;
  rig.camera.height = 120;
  rig.camera.fx = rig.camera.fy = 82;
  rig.camera.cx = 79;
  rig.camera.cy = 60;
  rig.T_body_camera = {ExpSO3(Eigen::Vector3d(1.1, -1.3, 1.2)), Eigen::Vector3d(0.13, 0.08, 0.02)};
  return rig;
}

Motion PlacedMotion(const std::string& name, double duration, const Rig& rig, const Scene& scene) {
  MotionSettings settings;
  settings.source = "builtin:" + name;
  settings.duration_s = duration;
  Motion motion = LoadMotion(settings, rig);
  PlaceInRoom(rig, scene, &motion);
  return motion;
}

EventArray Events(const Rig& rig, const Scene& scene, const Motion& motion, const Disturbances& disturbances,
                  double noise_hz) {
  const Renderer renderer(rig.camera, scene);
  const RenderSchedule schedule = PlanRenders(motion.spline, rig, scene, motion.begin, motion.end, 0.7, 2);
  EventSensorSettings sensor;
  sensor.noise_hz = noise_hz;
  sensor.hot_pixels = 0;
  EventArray all;
  SimulateEvents(
      renderer, motion.spline, rig, schedule, disturbances, {{}, sensor, {}}, 1, 2,
      [&](const EventArray& part) {
        for (std::size_t i = 0; i < part.size(); ++i)
          all.push_back(part.t[i], part.x[i], part.y[i], part.p[i]);
      },
      nullptr);
  return all;
}

std::size_t Between(const EventArray& events, Utime from, Utime to) {
  return static_cast<std::size_t>(std::lower_bound(events.t.begin(), events.t.end(), to) -
                                  std::lower_bound(events.t.begin(), events.t.end(), from));
}

TEST(Cover, OpensAndCloses) {
  const Cover cover{1'000'000, 1'600'000, 100'000};
  EXPECT_EQ(cover.Factor(899'999), 1);
  EXPECT_EQ(cover.Factor(1'000'000), 0);
  EXPECT_EQ(cover.Factor(1'300'000), 0);
  EXPECT_EQ(cover.Factor(1'600'000), 0);
  EXPECT_NEAR(cover.Factor(1'650'000), 0.25, 1e-9);
  EXPECT_EQ(cover.Factor(1'700'001), 1);
  EXPECT_EQ(Cover{}.Factor(0), 1);
}

// In the dark the camera sees nothing, however it moves; before and after it does, and the change itself
// shows.
TEST(Cover, LeavesOnlyNoise) {
  const Rig rig = SmallRig();
  const Scene scene = MakeRoom(1);
  const Motion motion = PlacedMotion("fast", 0.8, rig, scene);
  Disturbances dark;
  dark.cover.from = motion.begin + 300'000;
  dark.cover.to = motion.begin + 500'000;
  const EventArray events = Events(rig, scene, motion, dark, 0);
  EXPECT_GT(Between(events, motion.begin, motion.begin + 200'000), 5'000U);
  EXPECT_EQ(Between(events, dark.cover.from + 15'000, dark.cover.to), 0U);
  EXPECT_GT(Between(events, motion.begin + 600'000, motion.end), 5'000U);
  EXPECT_GT(Between(events, dark.cover.to, dark.cover.to + 100'000), std::size_t{160} * 120 * 3);
  const EventArray noisy = Events(rig, scene, motion, dark, 5);
  const double expected = 5.0 * 160 * 120 * 0.185;
  EXPECT_NEAR(static_cast<double>(Between(noisy, dark.cover.from + 15'000, dark.cover.to)), expected,
              0.05 * expected);
}

TEST(MovingBox, MovesBeforeTheCameraAndNeverIntoIt) {
  const Rig rig = SmallRig();
  const Scene scene = MakeRoom(1);
  for (const char* name : {"robot_normal", "sofa_fast", "desk_normal"}) {
    const Motion motion = PlacedMotion(name, 12, rig, scene);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const MovingBox box(seed, motion.spline, rig, motion.begin, motion.end);
      EXPECT_GE(box.size().minCoeff(), 0.4);
      EXPECT_LE(box.size().maxCoeff(), 0.6);
      double speed = 0;
      int seen = 0, n = 0;
      for (Utime t = motion.begin; t + 20'000 <= motion.end; t += 20'000, ++n) {
        const SE3 T_map_camera = motion.spline.Pose(t) * rig.T_body_camera;
        const Eigen::Vector3d p = box.Pose(t).p;
        speed += (box.Pose(t + 20'000).p - p).norm() / 0.02;
        EXPECT_GT((box.Pose(t).Inverse() * T_map_camera.p).cwiseAbs().maxCoeff(), 0.31)
            << name << ' ' << seed;
        Eigen::Vector2d pixel;
        if (rig.camera.Project(T_map_camera.Inverse() * p, &pixel) && rig.camera.Contains(pixel)) ++seen;
      }
      EXPECT_GT(speed / n, 0.28) << name << ' ' << seed;
      EXPECT_LT(speed / n, 0.5) << name << ' ' << seed;
      EXPECT_GT(seen, n / 4) << name << ' ' << seed;
    }
  }
}

// Where the box is, the picture and the events are another; elsewhere they are the same.
TEST(MovingBox, IsSeenButLeavesTheRestAlone) {
  const Rig rig = SmallRig();
  const Scene scene = MakeRoom(1);
  const Motion motion = PlacedMotion("handheld", 0.5, rig, scene);
  const MovingBox box(2, motion.spline, rig, motion.begin, motion.end);
  const Renderer renderer(rig.camera, scene);
  const SE3 T_map_camera = motion.spline.Pose(motion.begin) * rig.T_body_camera;
  View with, without;
  renderer.Render(T_map_camera, &without);
  renderer.Render(T_map_camera, &with, box.At(motion.begin));
  const auto first = static_cast<std::int32_t>(scene.surfaces.size());
  int on_box = 0;
  for (std::size_t i = 0; i < with.image.size(); ++i) {
    if (with.surface[i] >= first) {
      ++on_box;
      EXPECT_GE(with.inverse_depth[i], without.inverse_depth[i]);
    } else {
      EXPECT_EQ(with.surface[i], without.surface[i]);
    }
  }
  EXPECT_GT(on_box, 200);
  Disturbances disturbances;
  disturbances.box = &box;
  const EventArray a = Events(rig, scene, motion, {}, 0), b = Events(rig, scene, motion, disturbances, 0);
  EXPECT_NE(a.t, b.t);
}

// A plain room gives far fewer edges to go by, yet some.
TEST(PlainRoom, HasLittleTexture) {
  const Rig rig = SmallRig();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::size_t edges[2] = {0, 0};
    for (const bool plain : {false, true}) {
      const Scene scene = MakeRoom(seed, plain ? RoomKind::kPlain : RoomKind::kFurnished);
      const Motion motion = PlacedMotion("sofa_normal", 4, rig, scene);
      const Renderer renderer(rig.camera, scene);
      View view;
      for (Utime t = motion.begin; t <= motion.end; t += 500'000) {
        renderer.Render(motion.spline.Pose(t) * rig.T_body_camera, &view);
        edges[plain ? 1 : 0] += FindEdges(view, rig.camera.width, rig.camera.height, 0.1).size();
      }
    }
    EXPECT_LT(edges[1], edges[0] * 6 / 10) << seed;
    EXPECT_GT(edges[1], 400U) << seed;
  }
}

}  // namespace
}  // namespace evit::simulation
