#include "common/tracking/event_lag.h"

#include <gtest/gtest.h>

#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

TEST(EventLag, PointsShowBehindTheirMotionByTheSameNumberOfPixels) {
  const AlignmentSettings settings = synthetic::Alignment();
  const SE3 pose = synthetic::Motion().State(1.0).T_map_body;
  const std::vector<Eigen::Vector3f> room = synthetic::RoomPoints();
  const Eigen::Vector3d velocity(0.3, -0.2, 0.1);
  for (const double speed : {0.2, 5.0}) {  // slow and fast: the same lag
    const Eigen::Vector3d rate = speed * Eigen::Vector3d(0.3, 0.5, -0.4);
    const auto shown = CompensateEventLag(settings, room, pose, speed * velocity, rate, 0.5);
    // A moment later, as seen by the body that has moved on.
    constexpr double kDt = 1e-4;
    const SE3 later{(pose.q * ExpSO3(kDt * rate)).normalized(), pose.p + kDt * speed * velocity};
    int n = 0;
    for (std::size_t k = 0; k < room.size(); ++k) {
      Eigen::Vector2d now, then, seen;
      const auto project = [&](const SE3& body, const Eigen::Vector3d& p, Eigen::Vector2d* uv) {
        return settings.camera().Project(settings.T_camera_body * (body.Inverse() * p), uv);
      };
      if (!project(pose, room[k].cast<double>(), &now) || !project(later, room[k].cast<double>(), &then) ||
          !project(pose, shown.At(k), &seen) || !settings.camera().Contains(now)) {
        continue;
      }
      const Eigen::Vector2d flow = (then - now) / kDt;
      if (flow.norm() < 20) continue;
      const double expected = 0.5 * flow.norm() / (flow.norm() + 5);
      EXPECT_NEAR((seen - now).norm(), expected, 0.02);
      EXPECT_LT((seen - now).dot(flow), -0.99 * expected * flow.norm());
      ++n;
    }
    EXPECT_GT(n, 100);
  }
  const AlignmentPoints same = CompensateEventLag(settings, room, pose, velocity, {0, 0, 1}, 0);
  for (std::size_t k = 0; k < room.size(); ++k) EXPECT_LT((same.At(k) - room[k].cast<double>()).norm(), 1e-6);
}

}  // namespace
}  // namespace evit
