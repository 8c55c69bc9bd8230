#include "common/tracking/place_search.h"

#include <gtest/gtest.h>

#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

TEST(PlaceSearch, PlacesFillTheBallEvenly) {
  constexpr int kPlaces = 2000;
  int inner = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int k = 1; k <= kPlaces; ++k) {
    const Eigen::Vector3d p = PlaceInBall(k, 2.0);
    EXPECT_LE(p.norm(), 2.0 + 1e-9);
    inner += p.norm() < 1.0 ? 1 : 0;
    mean += p / kPlaces;
  }
  EXPECT_LT(mean.norm(), 0.03);
  EXPECT_NEAR(inner / double{kPlaces}, 0.125, 0.02);  // an eighth of the volume
  EXPECT_EQ(PlaceInBall(0, 2.0).norm(), 0);
}

TEST(PlaceSearch, FindsABodyThatIsDecimetresOff) {
  const AlignmentSettings settings = synthetic::Alignment();
  const std::vector<Eigen::Vector3f> room = synthetic::RoomPoints();
  const synthetic::Motion motion;
  int nearer = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const SE3 truth = motion.State(0.3 * trial).T_map_body;
    const SurfaceField field(synthetic::DrawSurface(settings, room, truth), 4);
    SE3 start = truth;
    start.p += Eigen::Vector3d(0.3, -0.25, 0.2);
    const SE3 found = BestPlace(settings, field, room, start, 0.6, 1, 400);
    nearer += (found.p - truth.p).norm() < 0.15 ? 1 : 0;
  }
  EXPECT_GE(nearer, 8);
}

}  // namespace
}  // namespace evit
