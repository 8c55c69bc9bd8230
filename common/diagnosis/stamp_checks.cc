#include "common/diagnosis/stamp_checks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/diagnosis/median.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kCoarseStep = 1.5e-3;  // s: what moves by three pixels in that is sharp no more
constexpr double kEventsPerStamp = 20;  // at fewer, few events come so far apart by themselves
constexpr double kFewestStamps = 1'000;

struct StampUnit {
  double factor;  // by which stamps are too large
  const char* name;
};
constexpr std::array<StampUnit, 4> kStampUnits{
    {{1000, "nanoseconds"}, {1e-3, "milliseconds"}, {1e-6, "seconds"}, {1e6, "picoseconds"}}};

// The unit that makes times larger by about such a factor, or null.
const StampUnit* StampUnitOf(double factor, double within) {
  for (const StampUnit& unit : kStampUnits)
    if (factor > unit.factor / within && factor < unit.factor * within) return &unit;
  return nullptr;
}

Finding StampsInUnit(const char* check, const char* whose, const StampUnit& unit, const std::string& figure) {
  return {
      check, Severity::kError, figure,
      FormatText("The stamps of %s are in %s, and were taken for microseconds.", whose, unit.name),
      FormatText("multiply them by %g where the recording is made or converted; `evit import` tells units by "
                 "itself",
                 1 / unit.factor)};
}

double UsualStep(const std::vector<ImuSample>& imu) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < imu.size(); ++k)
    if (imu[k].t > imu[k - 1].t) steps.push_back(ToSeconds(imu[k].t - imu[k - 1].t));
  return steps.size() < 3 ? 0 : Median(steps);
}

Finding StampSteps(const EventCensus& e) {
  const double stamps = static_cast<double>(std::max<std::int64_t>(1, e.stamps())),
               step = e.seconds() / stamps, per_stamp = static_cast<double>(e.count()) / stamps;
  const std::string figure =
      FormatText("%.1f events with one stamp, %.3g ms from stamp to stamp", per_stamp, 1e3 * step);
  if (static_cast<double>(e.count()) < kFewestStamps || per_stamp < kEventsPerStamp || step < kCoarseStep)
    return Good("event-stamps", figure);
  return {"event-stamps", step > 0.01 ? Severity::kError : Severity::kWarning, figure,
          FormatText(
              "Events are stamped every %.1f ms only: their times were rounded, or are those of packets or "
              "frames.",
              1e3 * step),
          "stamp each event by the sensor's clock, in microseconds"};
}

}  // namespace

Findings CheckStamps(const EventCensus& events, double event_seconds, const std::vector<ImuSample>& imu,
                     double imu_seconds, const Rig& rig) {
  Findings found;
  const double step = UsualStep(imu), imu_factor = step * rig.imu_rate_hz;
  const StampUnit* of_imu = StampUnitOf(imu_factor, 2);
  if (of_imu != nullptr) {
    found.push_back(
        StampsInUnit("imu-stamps", "the IMU", *of_imu,
                     FormatText("%.3g samples/s; the rig file says %.0f", 1 / step, rig.imu_rate_hz)));
  } else if (step > 0) {
    found.push_back(Good("imu-stamps", FormatText("%.3g ms from sample to sample", 1e3 * step)));
  }
  if (events.count() == 0) return found;
  const double seconds = imu_seconds / (of_imu != nullptr ? of_imu->factor : 1);
  const StampUnit* of_events = seconds > 0 ? StampUnitOf(event_seconds / seconds, 1.5) : nullptr;
  found.push_back(of_events == nullptr ? StampSteps(events)
                                       : StampsInUnit("event-stamps", "events", *of_events,
                                                      FormatText("events for %.3g s, IMU for %.3g s",
                                                                 event_seconds, imu_seconds)));
  return found;
}

}  // namespace evit::diagnosis
