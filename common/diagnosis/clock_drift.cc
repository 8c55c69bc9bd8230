#include "common/diagnosis/clock_drift.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/diagnosis/excerpt_views.h"
#include "common/diagnosis/placement_fit.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr Utime kOffsetStep = 8'000, kMostOffset = 320'000;  // us
constexpr double kDriftStep = 0.004, kMostRate = 0.08;
constexpr double kLeastWithDrift = 0.12, kLeastByDrift = 0.08;  // of 1
// Standard errors: of views in the middle an offset alone is as good, so that the gain is uneven by nature.
constexpr double kCertainDrift = 2.5;

struct RunningClock {
  double offset = 0;  // us, to add to the events' stamps in the middle of the recording
  double rate = 0;    // us, to add further for each us after that
};

Utime MiddleOf(const EventExcerpts& excerpts) {
  return (excerpts.instants().front() + excerpts.instants().back()) / 2;
}

// Moves the poses instead of the events: what is to be added to these is taken off those.
World WithClock(World world, const RunningClock& clock, Utime middle) {
  const double zero = static_cast<double>(middle + world.rig.camera_time_offset);
  for (StampedPose& s : world.truth) {
    const double after = static_cast<double>(s.t) - zero - clock.offset;
    s.t = std::llround(zero + after / (1 + clock.rate));
  }
  return world;
}

PlacementFit MeasureClock(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                          const RunningClock& clock) {
  const World there = WithClock(world, clock, MiddleOf(excerpts));
  return MeasurePlacement(there, PlacementViews(map, there, excerpts), {});
}

// Of each view, row by row, at each offset from the least to the largest.
using OffsetTable = std::vector<std::vector<double>>;

OffsetTable OverlapsByOffset(const MapIndex& map, const World& world, const EventExcerpts& excerpts) {
  MapViewOptions options;
  options.max_points = 500;
  OverlapOptions coarse;
  coarse.both_ways = false;
  OffsetTable table(excerpts.instants().size());
  for (Utime offset = -kMostOffset; offset <= kMostOffset; offset += kOffsetStep) {
    World there = world;
    there.rig.camera_time_offset += offset;
    for (std::vector<double>& row : table) row.push_back(0);
    for (const MapView& view : ViewsOf(map, there, excerpts, 1, options)) {
      const auto nearest = std::lower_bound(excerpts.instants().begin(), excerpts.instants().end(),
                                            (view.begin + view.end) / 2);
      if (nearest == excerpts.instants().end()) continue;
      table[static_cast<std::size_t>(nearest - excerpts.instants().begin())].back() =
          MeasureOverlap(there.rig, {view}, coarse).kappa();
    }
  }
  return table;
}

// The best clock that runs evenly, by the table.
RunningClock BestClock(const OffsetTable& table, const EventExcerpts& excerpts, double most_rate) {
  RunningClock best;
  double most = -1;
  const Utime middle = MiddleOf(excerpts);
  for (double rate = -most_rate; rate <= most_rate + 1e-9; rate += kDriftStep) {
    for (Utime offset = -kMostOffset; offset <= kMostOffset; offset += kOffsetStep) {
      double sum = 0;
      for (std::size_t k = 0; k < table.size(); ++k) {
        const double at =
            static_cast<double>(offset) + rate * static_cast<double>(excerpts.instants()[k] - middle);
        const auto j =
            std::lround((at + static_cast<double>(kMostOffset)) / static_cast<double>(kOffsetStep));
        if (j >= 0 && j < static_cast<long>(table[k].size())) sum += table[k][static_cast<std::size_t>(j)];
      }
      if (sum > most) most = sum, best = {static_cast<double>(offset), rate};
    }
  }
  return best;
}

// From there in smaller steps.
std::pair<RunningClock, PlacementFit> RefineClock(const MapIndex& map, const World& world,
                                                  const EventExcerpts& excerpts, RunningClock clock,
                                                  bool drifts) {
  PlacementFit best = MeasureClock(map, world, excerpts, clock);
  for (const double part : {0.5, 0.25}) {
    for (const auto& [offset, rate] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, 0}, {1, 0}}) {
      if (!drifts && rate != 0) continue;
      const RunningClock tried{clock.offset + part * offset * static_cast<double>(kOffsetStep),
                               clock.rate + part * rate * kDriftStep};
      PlacementFit fit = MeasureClock(map, world, excerpts, tried);
      if (fit.overlap > best.overlap) best = std::move(fit), clock = tried;
    }
  }
  return {clock, best};
}

}  // namespace

std::optional<Finding> CheckClockDrift(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                                       double best) {
  if (excerpts.instants().size() < 5) return {};
  const OffsetTable table = OverlapsByOffset(map, world, excerpts);
  const auto [even, at_one] = RefineClock(map, world, excerpts, BestClock(table, excerpts, 0), false);
  const auto [clock, fit] = RefineClock(map, world, excerpts, BestClock(table, excerpts, kMostRate), true);
  const double seconds = ToSeconds(excerpts.instants().back() - excerpts.instants().front());
  if (fit.overlap < std::max({kLeastWithDrift, best + kLeastByDrift, at_one.overlap + kLeastByDrift}) ||
      Better(fit, at_one) < kCertainDrift)
    return {};
  return Finding{
      "clock-drift", Severity::kError,
      FormatText("overlap of map and events %.2f, of 1, with a drift, %.2f with an offset alone", fit.overlap,
                 at_one.overlap),
      FormatText(
          "The camera's clock runs %.1f %% too %s: it is %.0f ms further off the truth's after %.1f s.",
          100 * std::abs(clock.rate), clock.rate > 0 ? "slow" : "fast", 1e3 * std::abs(clock.rate) * seconds,
          seconds),
      "stamp events, IMU and poses by one clock; one that is off by a percent counts ticks of another rate "
      "than the driver assumes"};
}

}  // namespace evit::diagnosis
