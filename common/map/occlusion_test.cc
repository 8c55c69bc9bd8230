#include "common/map/occlusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/helpers/clouds.h"

namespace evit {
namespace {

// A wall 3 m ahead with a poster's grid of lines on it, and, 1.5 m ahead, a box of 0.8 x 0.8 m whose face has
// lines too: every edge point of a scene as a semi-dense map holds it.
struct BoxBeforeWall {
  PointMap map;
  std::vector<bool> behind;  // truly hidden: the line of sight from the origin meets the face

  explicit BoxBeforeWall(float spacing) {
    const auto lines = [&](float half, float z, float pitch) {
      for (float a = -half; a <= half + 1e-4F; a += pitch) {
        for (float b = -half; b <= half; b += spacing) {
          Add({a, b, z});
          Add({b, a, z});
        }
      }
    };
    lines(0.4F, 1.5F, 0.1F);
    lines(2.0F, 3.0F, 0.1F);
  }
  void Add(const Eigen::Vector3f& p) {
    map.points.push_back(p);
    const Eigen::Vector2f at_face = p.head<2>() * (1.5F / p.z());
    behind.push_back(p.z() > 2 && at_face.cwiseAbs().maxCoeff() < 0.4F);
  }
};

VisibilityQuery Query() {
  VisibilityQuery q;
  q.camera = test::PlumbBob();
  return q;
}

TEST(OcclusionTest, BoxHidesTheWallBehindItAndNothingElse) {
  const BoxBeforeWall scene(0.01F);
  const MapIndex index(scene.map);
  VisibilityQuery q = Query();
  const std::vector<std::int32_t> with = index.Query(q).ids;
  q.occlusion = false;
  const std::vector<std::int32_t> without = index.Query(q).ids;
  const std::set<std::int32_t> kept(with.begin(), with.end());
  // Within two cells of the box's outline either answer will do: the buffer is no finer.
  const auto near_outline = [&](std::int32_t id) {
    const Eigen::Vector3f& p = scene.map.points[id];
    return std::abs((p.head<2>() * (1.5F / p.z())).cwiseAbs().maxCoeff() - 0.4F) < 16 * 1.5F / 327;
  };
  int hidden = 0, found = 0, open = 0, lost = 0;
  for (const std::int32_t id : without) {
    if (near_outline(id)) continue;
    (scene.behind[id] ? hidden : open) += 1;
    if (kept.count(id) == 0) (scene.behind[id] ? found : lost) += 1;
  }
  ASSERT_GT(hidden, 1000);
  ASSERT_GT(open, 10'000);
  EXPECT_GT(found, 0.95 * hidden) << found << " of " << hidden;
  EXPECT_EQ(lost, 0) << " of " << open;
}

TEST(OcclusionTest, NothingWithoutDepthDifference) {
  // A slanted wall: neighbours differ in depth, but by less than a nearer surface would.
  std::mt19937 random(4);
  PointMap map;
  for (int k = 0; k < 30'000; ++k) {
    const float x = test::Uniform(&random, -2, 2), y = test::Uniform(&random, -1.5F, 1.5F);
    map.points.emplace_back(x, y, 3 + 0.5F * x);
  }
  const MapIndex index(map);
  VisibilityQuery q = Query();
  const int with = index.Query(q).n_visible;
  q.occlusion = false;
  EXPECT_EQ(with, index.Query(q).n_visible);
}

TEST(OcclusionTest, ALonelyEdgeOrStrayHidesNothing) {
  // A wire and single points in front of a wall: evidence on one or two sides only.
  std::mt19937 random(6);
  PointMap map;
  for (int k = 0; k < 20'000; ++k) {
    map.points.emplace_back(test::Uniform(&random, -2, 2), test::Uniform(&random, -1.5F, 1.5F), 3.0F);
  }
  for (int k = 0; k < 500; ++k) map.points.emplace_back(0.1F, 0.003F * static_cast<float>(k - 250), 1.0F);
  for (int k = 0; k < 20; ++k) {
    map.points.emplace_back(test::Uniform(&random, -0.8F, 0.8F), test::Uniform(&random, -0.6F, 0.6F), 1.0F);
  }
  const MapIndex index(map);
  VisibilityQuery q = Query();
  const int with = index.Query(q).n_visible;
  q.occlusion = false;
  const int without = index.Query(q).n_visible;
  EXPECT_GT(without, 10'000);
  EXPECT_LT(without - with, 0.01 * without) << without - with;
}

TEST(OcclusionTest, TwoNearerPointsOnThreeSidesHide) {
  // The rule itself, around one far point.
  Camera camera = test::PlumbBob();
  const auto kept = [&](int sides, int per_side, float depth) {
    std::vector<ProjectedPoint> points = {{0, {324, 244}, 2.0F}};
    const float step = 12;
    const Eigen::Vector2f at[] = {{-step, -step}, {step, -step}, {step, step}, {-step, step}};
    for (int side = 0; side < sides; ++side) {
      for (int k = 0; k < per_side; ++k) points.push_back({k + 1, points[0].pixel + at[side], depth});
    }
    RemoveOccluded(camera, 0, &points);
    return !points.empty() && points[0].id == 0;
  };
  EXPECT_FALSE(kept(4, 2, 1.0F));
  EXPECT_FALSE(kept(3, 2, 1.0F));
  EXPECT_TRUE(kept(2, 2, 1.0F));
  EXPECT_TRUE(kept(4, 1, 1.0F));
  EXPECT_FALSE(kept(4, 2, 1.79F));
  EXPECT_TRUE(kept(4, 2, 1.81F));  // less than a tenth nearer
  EXPECT_TRUE(kept(4, 2, 2.5F));
}

TEST(OcclusionTest, PointsOutToTheMarginsEdge) {
  Camera camera = test::PlumbBob();
  for (const double margin : {0.0, 0.5, 33.0, 1000.0}) {
    std::vector<ProjectedPoint> points;
    const auto m = static_cast<float>(margin);
    for (const float x : {-m, 639 + m}) {
      for (const float y : {-m, 479 + m}) points.push_back({static_cast<int>(points.size()), {x, y}, 1.0F});
    }
    RemoveOccluded(camera, margin, &points);
    EXPECT_EQ(points.size(), 4u);
  }
}

}  // namespace
}  // namespace evit
