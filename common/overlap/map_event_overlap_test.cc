#include "common/overlap/map_event_overlap.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace evit {
namespace {

// A camera before a wall of random points, moving sideways at 0.3 m/s; events where the points are.
class OverlapTest : public ::testing::Test {
 protected:
  OverlapTest() {
    rig_.camera.width = 320;
    rig_.camera.height = 240;
    rig_.camera.fx = rig_.camera.fy = 200;
    rig_.camera.cx = 160;
    rig_.camera.cy = 120;
    rig_.camera_time_offset = 7'000;
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> u(-1, 1);
    PointMap map;
    for (int k = 0; k < 400; ++k) map.points.emplace_back(1.2 * u(rng), 0.9 * u(rng), 2.0 + 0.2 * u(rng));
    map_ = std::make_unique<MapIndex>(std::move(map));
    for (Utime t = 0; t <= 1'000'000; t += 10'000)
      body_.push_back({t, {Eigen::Quaterniond::Identity(), {0.3 * ToSeconds(t), 0, 0}}});
  }

  // Every visible point fires once in each view, `shift` beside where it is; in pieces.
  std::vector<MapView> Views(double shift) {
    std::vector<MapView> views = PlanViews(*map_, rig_, body_);
    EventArray events;
    ViewFiller filler(&views);
    for (const MapView& view : std::vector<MapView>(views)) {
      const SE3 T_camera_map = (view.T_map_body * rig_.T_body_camera).Inverse();
      for (const Eigen::Vector3f& p : view.points) {
        Eigen::Vector2d pixel;
        if (!rig_.camera.Project(T_camera_map * p.cast<double>(), &pixel) || !rig_.camera.Contains(pixel, 12))
          continue;
        events.push_back((view.begin + view.end) / 2,
                         static_cast<std::uint16_t>(std::lround(pixel.x() + shift)),
                         static_cast<std::uint16_t>(std::lround(pixel.y())), 1);
        if (events.size() == 100) {
          filler.AddEvents(events);
          events.clear();
        }
      }
    }
    filler.AddEvents(events);
    return views;
  }

  Rig rig_;
  std::unique_ptr<MapIndex> map_;
  Trajectory body_;
};

TEST_F(OverlapTest, SlicesLastUntilThePointsHaveMovedSoFarInTheEventsClock) {
  const std::vector<MapView> views = PlanViews(*map_, rig_, body_);
  ASSERT_EQ(views.size(), 10U);
  EXPECT_NEAR(views[0].speed_px, 0.3 * 200 / 2.0, 2);
  EXPECT_EQ(views[0].end - views[0].begin, 40'000);  // 100 ms would be needed: the longest
  EXPECT_EQ((views[0].begin + views[0].end) / 2, views[0].utime - 7'000);
  MapViewOptions fine;
  fine.slice_px = 0.6;
  EXPECT_NEAR(static_cast<double>(PlanViews(*map_, rig_, body_, fine)[3].end -
                                  PlanViews(*map_, rig_, body_, fine)[3].begin),
              20'000, 1500);
}

TEST_F(OverlapTest, EventsOnTheMapAreFoundAndChanceIsKnown) {
  const MapEventOverlap overlap = MeasureOverlap(rig_, Views(0));
  EXPECT_EQ(overlap.views, 10);
  EXPECT_GT(overlap.point_share(), 0.9);
  EXPECT_DOUBLE_EQ(overlap.event_share(), 1);
  EXPECT_LT(overlap.point_share_by_chance(), 0.15);
  EXPECT_LT(overlap.event_share_by_chance(), 0.15);
  EXPECT_GT(overlap.kappa(), 0.9);
  EXPECT_LT(overlap.mean_offset().norm(), 0.05);
  EXPECT_GT(overlap.distances[0], overlap.distances[2]);
}

TEST_F(OverlapTest, ShiftedEventsShowTheirOffset) {
  const MapEventOverlap near = MeasureOverlap(rig_, Views(1)), far = MeasureOverlap(rig_, Views(5));
  EXPECT_NEAR(near.mean_offset().x(), 1, 0.1);
  EXPECT_NEAR(near.mean_offset().y(), 0, 0.05);
  EXPECT_LT(far.kappa(), 0.1);
  EXPECT_GT(far.distances[9] + far.distances[10], far.points / 2);
}

TEST_F(OverlapTest, RecordingWithoutEventsOrViewsGivesZeros) {
  std::vector<MapView> views = PlanViews(*map_, rig_, body_);
  ViewFiller(&views).AddEvents({});
  const MapEventOverlap overlap = MeasureOverlap(rig_, views);
  EXPECT_EQ(overlap.point_share(), 0);
  EXPECT_EQ(overlap.event_share(), 0);
  EXPECT_TRUE(PlanViews(*map_, rig_, {}).empty());
  EXPECT_EQ(MeasureOverlap(rig_, std::vector<MapView>{}).events_per_edge_pixel(), 0);
}

}  // namespace
}  // namespace evit
