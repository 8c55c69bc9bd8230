#include "common/map/map_index.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <set>

#include "tests/helpers/clouds.h"

namespace evit {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// What a camera sees, one point after the other.
std::vector<std::int32_t> BruteForce(const PointMap& map, const VisibilityQuery& q) {
  std::vector<std::int32_t> ids;
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    const Eigen::Vector3d p = q.T_map_camera.Inverse() * map.points[k].cast<double>();
    Eigen::Vector2d pixel;
    if (p.z() >= q.min_depth && p.z() <= q.max_depth && q.camera.Project(p, &pixel) &&
        pixel.x() >= -q.margin_px && pixel.x() <= q.camera.width - 1 + q.margin_px &&
        pixel.y() >= -q.margin_px && pixel.y() <= q.camera.height - 1 + q.margin_px) {
      ids.push_back(static_cast<std::int32_t>(k));
    }
  }
  return ids;
}

TEST(MapIndexTest, SeesWhatBruteForceSees) {
  const PointMap room = test::Room(20'000, {3, 2.5F, 1.4F}, 1);
  const MapIndex index(room);
  EXPECT_EQ(index.map().points, room.points);
  std::mt19937 random(5);
  const std::pair<const char*, Camera> cameras[] = {
      {"plumb_bob", test::PlumbBob()}, {"barrel", test::StrongBarrel()}, {"fisheye", test::Fisheye()}};
  for (const auto& [name, camera] : cameras) {
    std::size_t seen = 0;
    for (int k = 0; k < 30; ++k) {
      VisibilityQuery q;
      q.T_map_camera = test::RandomPose(&random, k % 3 == 0 ? 8.0F : 2.0F);  // outside the room, too
      q.camera = camera;
      q.margin_px = k % 4 * 30;
      q.min_depth = k % 2 == 0 ? 0.1 : 1.2;
      q.max_depth = k % 5 == 0 ? 2.5 : 20;
      q.occlusion = false;
      const std::vector<std::int32_t> expected = BruteForce(room, q);
      const VisibilityAnswer answer = index.Query(q);
      EXPECT_EQ(answer.ids, expected) << name << ' ' << k;
      EXPECT_EQ(answer.n_visible, static_cast<std::int32_t>(expected.size()));
      seen += expected.size();
    }
    EXPECT_GT(seen, 30'000u) << name;  // or this has tested nothing
  }
}

TEST(MapIndexTest, EdgeOfImageMarginAndDepth) {
  Camera camera;
  camera.width = 101;
  camera.height = 81;
  camera.fx = camera.fy = 100;
  camera.cx = 50;
  camera.cy = 40;
  VisibilityQuery q;
  q.camera = camera;
  q.min_depth = 0.5;
  q.max_depth = 4;
  q.occlusion = false;
  const MapIndex index({{{0, 0, 2},
                         {0.99F, 0, 2},     // pixel 99.5 of 0..100
                         {1.01F, 0, 2},     // pixel 100.5
                         {0, -0.81F, 2},    // row -0.5
                         {0, 0, -2},        // behind
                         {0, 0, 0},         // at the optical centre
                         {0, 0, 0.49F},     // too near
                         {0, 0, 4.01F}}});  // too far
  EXPECT_THAT(index.Query(q).ids, ElementsAre(0, 1));
  q.margin_px = 1;
  EXPECT_THAT(index.Query(q).ids, ElementsAre(0, 1, 2, 3));
  q.min_depth = 0;
  q.max_depth = 100;
  EXPECT_THAT(index.Query(q).ids, ElementsAre(0, 1, 2, 3, 6, 7));
}

TEST(MapIndexTest, StraysFarAwayAndASinglePoint) {
  VisibilityQuery q;
  q.camera = test::PlumbBob();
  q.max_depth = 1e30;
  const MapIndex strays({{{0, 0, 3e38F}, {-3e38F, 2e38F, 1e38F}, {0, 0, 1e12F}, {0, 0, 1}}});
  EXPECT_THAT(strays.Query(q).ids, ElementsAre(2, 3));
  q.T_map_camera.p.z() = 2;
  q.max_depth = 20;
  EXPECT_THAT(MapIndex({{{0, 0, 1}}}).Query(q).ids, IsEmpty());
}

class SubsetTest : public ::testing::Test {
 protected:
  // A wall 2 m ahead, evenly covered, with one spot of 20 x 20 cm that holds as many points again.
  SubsetTest() {
    std::mt19937 random(2);
    PointMap map;
    for (int k = 0; k < 20'000; ++k) {
      const float reach = k < 10'000 ? 1.5F : 0.1F;
      map.points.emplace_back(test::Uniform(&random, -reach, reach), test::Uniform(&random, -reach, reach),
                              2.0F);
    }
    index_ = std::make_unique<MapIndex>(std::move(map));
    query_.camera = test::PlumbBob();
    query_.max_points = 1000;
    query_.seed = 7;
  }
  std::unique_ptr<MapIndex> index_;
  VisibilityQuery query_;
};

TEST_F(SubsetTest, SizeOrderAndMembership) {
  VisibilityQuery all = query_;
  all.max_points = 0;
  const VisibilityAnswer whole = index_->Query(all);
  const std::set<std::int32_t> members(whole.ids.begin(), whole.ids.end());
  for (const int n : {1, 2, 37, 1000, 5000, whole.n_visible - 1}) {
    query_.max_points = n;
    const VisibilityAnswer part = index_->Query(query_);
    ASSERT_EQ(part.ids.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(part.n_visible, whole.n_visible);
    for (std::size_t k = 0; k < part.ids.size(); ++k) {
      EXPECT_EQ(members.count(part.ids[k]), 1u);
      if (k > 0) {
        EXPECT_LT(part.ids[k - 1], part.ids[k]);
      }
    }
  }
  query_.max_points = whole.n_visible;
  EXPECT_EQ(index_->Query(query_).ids, whole.ids);
}

TEST_F(SubsetTest, SameQuerySameAnswerAnotherSeedAnother) {
  const std::vector<std::int32_t> first = index_->Query(query_).ids;
  EXPECT_EQ(index_->Query(query_).ids, first);
  EXPECT_EQ(MapIndex(index_->map()).Query(query_).ids, first);
  query_.seed = 8;
  EXPECT_NE(index_->Query(query_).ids, first);
}

TEST_F(SubsetTest, DenseSpotDoesNotEatTheBudget) {
  const std::vector<std::int32_t> ids = index_->Query(query_).ids;
  const auto dense = std::count_if(ids.begin(), ids.end(), [](std::int32_t id) { return id >= 10'000; });
  // Drawn from all points alike it would be half. The spot covers some four tiles of two hundred.
  EXPECT_LT(dense, 40);
  EXPECT_GT(dense, 0);
}

TEST_F(SubsetTest, EveryPointHasItsChance) {
  // 400 seeds: within a tile of equal density no point is favoured. Points of the sparse part, away from the
  // spot, are drawn about equally often.
  std::map<std::int32_t, int> count;
  for (int seed = 0; seed < 400; ++seed) {
    query_.seed = static_cast<std::uint64_t>(seed);
    for (const std::int32_t id : index_->Query(query_).ids) ++count[id];
  }
  double sum = 0, squares = 0;
  int n = 0;
  for (std::int32_t id = 0; id < 10'000; ++id) {
    const Eigen::Vector3f& p = index_->map().points[id];
    if (std::abs(p.x()) < 0.4F || std::abs(p.x()) > 1.2F || std::abs(p.y()) > 1.0F) continue;
    sum += count[id];
    squares += count[id] * count[id];
    ++n;
  }
  const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
  EXPECT_GT(mean, 20);
  EXPECT_LT(deviation,
            2.0 * std::sqrt(mean));  // near a binomial's; a stuck choice would give the mean itself
  // The ranks within the list are spread too: the order of the map must not matter.
  const std::vector<std::int32_t> ids = index_->Query(query_).ids;
  double first_half = 0;
  for (const std::int32_t id : ids) first_half += id < 5000 ? 1 : 0;
  EXPECT_NEAR(first_half / static_cast<double>(ids.size()), 0.49, 0.07);
}

TEST(MapIndexSpeedTest, HalfAMillionPoints) {
  const MapIndex index(test::Room(500'000, {4, 3, 1.5F}, 3));
  VisibilityQuery q;
  q.camera = test::PlumbBob();
  q.margin_px = 40;
  q.max_points = 3000;
  std::mt19937 random(1);
  std::vector<double> ms;
  std::int64_t visible = 0;
  for (int k = 0; k < 31; ++k) {
    q.T_map_camera = test::RandomPose(&random, 1);
    const auto begin = std::chrono::steady_clock::now();
    visible += index.Query(q).n_visible;
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(ms.begin(), ms.end());
  std::printf("500,000 points: %.2f ms median, %.2f at most, %lld visible on average\n", ms[15], ms.back(),
              static_cast<long long>(visible / 31));
  RecordProperty("median_ms", std::to_string(ms[15]));
  EXPECT_GT(visible, 31 * 10'000);
}

}  // namespace
}  // namespace evit
