#include "common/overlap/surface_values.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

// A row of points, whose pixels (or pixels `shift` beside) fire at each view.
SurfaceValues Measured(int shift, bool events) {
  Rig rig;
  rig.camera.width = 160;
  rig.camera.height = 120;
  rig.camera.fx = rig.camera.fy = 100;
  rig.camera.cx = 80;
  rig.camera.cy = 60;
  rig.camera_time_offset = 3'000;
  std::vector<MapView> views(3);
  SurfaceMeter meter(rig, &views);
  EventArray all;
  for (std::size_t v = 0; v < views.size(); ++v) {
    views[v].utime = 1'000'000 + 100'000 * static_cast<Utime>(v);
    views[v].speed_px = 100;
    for (int x = 30; x < 130; ++x) {
      views[v].points.emplace_back((x - 80) * 0.02F, 0.2F, 2.0F);
      // One half before the view's instant, one behind.
      if (events)
        all.push_back(views[v].utime - 3'000, static_cast<std::uint16_t>(x),
                      static_cast<std::uint16_t>(70 + shift), 1);
    }
  }
  for (std::size_t begin = 0; begin < all.size(); begin += 37) {
    EventArray part;
    for (std::size_t k = begin; k < std::min(all.size(), begin + 37); ++k)
      part.push_back(all.t[k], all.x[k], all.y[k], all.p[k]);
    meter.AddEvents(part);
  }
  meter.Finish();
  return meter.total();
}

TEST(SurfaceMeter, PointsOnEventsHaveLowValuesAndContrast) {
  const SurfaceValues on = Measured(0, true), beside = Measured(5, true);
  EXPECT_EQ(on.points, 300);
  EXPECT_LT(on.mean(), 170);  // the blur spreads a line of one pixel
  EXPECT_GT(on.contrast(), 0.2);
  EXPECT_GT(beside.mean(), 250);
  EXPECT_LT(std::abs(beside.contrast()), 0.05);
}

TEST(SurfaceMeter, NoEventsAreAnEmptySurface) {
  const SurfaceValues none = Measured(0, false);
  EXPECT_EQ(none.points, 300);
  EXPECT_EQ(none.mean(), 255);
  EXPECT_EQ(none.contrast(), 0);
  EXPECT_EQ(none.histogram[15], 300);
}

}  // namespace
}  // namespace evit
