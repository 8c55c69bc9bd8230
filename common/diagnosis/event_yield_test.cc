#include "common/diagnosis/event_yield.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "common/diagnosis/excerpt_views.h"
#include "tests/helpers/line_world.h"

namespace evit::diagnosis {
namespace {

constexpr int kYieldExcerpts = 4;

MapEventOverlap WithinAPixelOf(const MapIndex& map, const World& world, const EventExcerpts& excerpts) {
  return MeasureOverlap(world.rig, ViewsOf(map, world, excerpts), WithinAPixel());
}

// What the check says of a camera that makes an event of a `share` of what it could see from `real`.
std::optional<Finding> YieldFound(const PointMap& points, const World& given, const World& real, double share,
                                  int n_excerpts = kYieldExcerpts) {
  const MapIndex map(points);
  const EventExcerpts excerpts = test::EventsOf(points, real, test::Instants(n_excerpts), share);
  return CheckEventYield(map, given, excerpts, WithinAPixelOf(map, given, excerpts));
}

// The world as seen by a camera that is turned so far that nothing lies where it should.
World Turned(World world) {
  world.rig.T_body_camera.q = world.rig.T_body_camera.q * ExpSO3({0.1, 0.15, 0});
  return world;
}

TEST(EventYield, EdgesThatFireAreGood) {
  const World world = test::LineWorld();
  for (const double share : {1.0, 0.4}) EXPECT_FALSE(YieldFound(test::Lines(), world, world, share)) << share;
}

TEST(EventYield, EdgesThatHardlyFireAreTheCamerasFault) {
  const World world = test::LineWorld();
  for (const int lines : {36, 140}) {  // the more lines, the more fires all the same
    const std::optional<Finding> found = YieldFound(test::Lines(lines), world, world, 0.03);
    ASSERT_TRUE(found) << lines;
    EXPECT_EQ(found->check, "event-rate");
    EXPECT_EQ(found->severity, Severity::kError);
  }
}

TEST(EventYield, FewEventsOfAFewEdgesAreGood) {
  EXPECT_FALSE(YieldFound(test::Lines(8), test::LineWorld(), test::LineWorld(), 0.25));
}

TEST(EventYield, SoFewEventsSayNothingOfTheMapsPlace) {
  EXPECT_TRUE(YieldFound(test::Lines(), test::LineWorld(), Turned(test::LineWorld()), 0.01));
}

TEST(EventYield, ManyEventsBesideTheMapAreTheMapsFault) {
  EXPECT_FALSE(YieldFound(test::Lines(), test::LineWorld(), Turned(test::LineWorld()), 1));
}

// Where few of the points, but most of the events, lie on the other.
TEST(EventYield, EventsOnTheMapThatMissItsPointsAreTheCamerasFault) {
  const World world = test::LineWorld();
  const MapIndex map(test::Lines());
  const EventExcerpts excerpts = test::EventsOf(map.map(), world, test::Instants(kYieldExcerpts));
  MapEventOverlap given = WithinAPixelOf(map, world, excerpts);
  ASSERT_FALSE(CheckEventYield(map, world, excerpts, given));
  given.points_on_events = given.points / 50;
  given.points_on_events_beside = 0;
  EXPECT_TRUE(CheckEventYield(map, world, excerpts, given));
}

// Any event lies on a map that is everywhere.
TEST(EventYield, FewEventsOnAMapThatFillsTheImageSayNothing) {
  PointMap wall;
  for (float x = -2.4F; x < 2.4F; x += 0.035F)
    for (float y = -1.9F; y < 1.9F; y += 0.035F) wall.points.emplace_back(x, y, 0.5F);
  const World world = test::LineWorld();
  EXPECT_FALSE(YieldFound(wall, world, world, 0.02, 2));
}

TEST(EventYield, WithoutViewsOrPosesNothingIsTold) {
  World without = test::LineWorld();
  const MapIndex map(test::Lines());
  const EventExcerpts silent(test::Instants(kYieldExcerpts), 25'000);
  const MapEventOverlap given = WithinAPixelOf(map, without, silent);
  EXPECT_TRUE(CheckEventYield(map, without, silent, given)) << "none fires";
  EXPECT_FALSE(CheckEventYield(map, without, silent, {}));
  without.truth.clear();
  EXPECT_FALSE(CheckEventYield(map, without, silent, given));
}

}  // namespace
}  // namespace evit::diagnosis
