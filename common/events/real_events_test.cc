// Real events of a camera that moves sideways (slider_depth of the RPG event camera data set), where they
// are.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "common/events/keyframe_builder.h"
#include "common/events/surface_renderer.h"
#include "tests/helpers/event_streams.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

constexpr int kSensorWidth = 240, kSensorHeight = 180;

class RealEventsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string folder = test::RecordingsPath("slider_depth");
    std::ifstream file(folder + "/events_chunk.txt");
    if (!file) GTEST_SKIP() << "no events_chunk.txt in " << folder;
    double t = 0;
    for (int x = 0, y = 0, p = 0; file >> t >> x >> y >> p;) {
      events_.push_back(std::llround(t * 1e6), x, y, p);
    }
    ASSERT_GT(events_.size(), 10'000u);
  }
  EventArray events_;
};

enum class Side { kBefore, kAfter, kNearest };

SurfaceRenderer::Image Draw(const EventArray& events, Utime t, Side side) {
  const SurfaceOptions options = test::SmallOptions().surface;
  ActiveEventSurface surface(kSensorWidth, kSensorHeight);
  std::size_t middle = 0;
  while (middle < events.size() && events.t[middle] <= t) ++middle;
  if (side != Side::kAfter) {
    surface.Update(events.t.data(), events.x.data(), events.y.data(), middle);
  }
  SurfaceRenderer renderer(kSensorWidth, kSensorHeight, options);
  SurfaceRenderer::View view;
  view.t = t;
  view.decay_us = 15'000;
  if (side != Side::kBefore) {
    view.after = &events;
    view.begin = middle;
    view.end = events.size();
  }
  return renderer.Render(surface, view);
}

/// How far `b` lies to the right of `a`, pixels: least squared difference, refined by a parabola.
double ShiftX(const SurfaceRenderer::Image& a, const SurfaceRenderer::Image& b) {
  constexpr int kReach = 6;
  std::vector<double> cost;
  for (int s = -kReach; s <= kReach; ++s) {
    double sum = 0;
    for (int y = 0; y < kSensorHeight; ++y) {
      for (int x = kReach; x < kSensorWidth - kReach; ++x) {
        const double d = double(a[y * kSensorWidth + x]) - b[y * kSensorWidth + x + s];
        sum += d * d;
      }
    }
    cost.push_back(sum);
  }
  const auto best = std::min_element(cost.begin() + 1, cost.end() - 1);
  const double l = *(best - 1), m = *best, r = *(best + 1);
  return double(best - cost.begin()) - kReach + 0.5 * (l - r) / (l - 2 * m + r);
}

TEST_F(RealEventsTest, SymmetricSurfaceLiesMidwayBetweenPastAndFuture) {
  // At constant speed the past trails the edge exactly as far as the future leads it.
  for (const Utime t : {60'000, 80'000, 100'000, 120'000}) {
    const auto nearest = Draw(events_, t, Side::kNearest);
    const double past = ShiftX(nearest, Draw(events_, t, Side::kBefore));
    const double future = ShiftX(nearest, Draw(events_, t, Side::kAfter));
    std::printf("  t = %3d ms: past %+.2f px, future %+.2f px of the symmetric surface\n",
                static_cast<int>(t / 1000), past, future);
    EXPECT_LT(past * future, 0);
    EXPECT_GT(std::abs(past - future), 0.5);
    EXPECT_LT(std::abs(past + future) / 2, 0.3);
  }
}

TEST_F(RealEventsTest, KeyframesDoNotDependOnThePackets) {
  Rig rig = test::SmallRig();
  rig.camera.width = kSensorWidth;
  rig.camera.height = kSensorHeight;
  const std::vector<ImuSample> imu = test::ImuStream(0, 175'000);
  std::vector<Keyframe> results[2];
  for (int run = 0; run < 2; ++run) {
    KeyframeBuilder builder(rig, test::SmallOptions(), true);
    std::vector<Keyframe>& out = results[run];
    const auto take = [&] {
      while (auto k = builder.Next()) {
        TrackerFeedback f;
        if (k->seq >= 3) f = {TrackerFeedback::Mode::kTracking, 150};
        builder.SetFeedbackFor(k->seq, f);
        out.push_back(std::move(*k));
      }
    };
    if (run == 0) {
      for (const ImuSample& s : imu) builder.AddImu(s);
    }
    const std::size_t packet = run == 0 ? 4'001 : 333;
    for (std::size_t i = 0; i < events_.size(); i += packet) {
      const EventArray part = test::Slice(events_, i, std::min(i + packet, events_.size()));
      builder.AddEvents(part, part.t.back());
      take();
    }
    if (run == 1) {
      for (const ImuSample& s : imu) builder.AddImu(s), take();
    }
    builder.Flush();
    take();
  }
  ASSERT_GT(results[0].size(), 6u);
  ASSERT_EQ(results[0].size(), results[1].size());
  for (std::size_t i = 0; i < results[0].size(); ++i) {
    EXPECT_EQ(results[0][i].utime, results[1][i].utime);
    EXPECT_EQ(results[0][i].n_events, results[1][i].n_events);
    EXPECT_EQ(results[0][i].surface, results[1][i].surface) << i;
  }
}

}  // namespace
}  // namespace evit
