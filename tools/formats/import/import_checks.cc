#include "tools/formats/import/import_checks.h"

#include <algorithm>
#include <stdexcept>

#include "common/files/decimal_time.h"
#include "common/imu/imu_plausibility.h"

namespace evit::formats {
namespace {

// A longer hole is a damaged time stamp, or two clocks: its silence would fill the log with empty packets.
constexpr Utime kMaxHole = 600 * kMicrosPerSecond;

std::string OtherClock(Utime imu, Utime first_event) {
  return " (IMU " + DecimalSeconds(imu) + " s, first event " + DecimalSeconds(first_event) +
         " s): the files are from different sequences or clocks; if the clocks, --imu-offset SECONDS is "
         "added to the IMU's stamps";
}

}  // namespace

void CheckHole(const std::string& name, Utime before, Utime after) {
  if (after - before <= kMaxHole) return;
  throw std::runtime_error(
      name + ": the time jumps from " + DecimalSeconds(before) + " s to " + DecimalSeconds(after) +
      " s: a damaged time stamp, or several recordings; import each recording separately");
}

void CheckRate(const std::string& name, std::int64_t n, Utime span) {
  constexpr std::int64_t kFew = 1000;
  constexpr double kSlowest = 0.1;  // s an event
  if (n < kFew || ToSeconds(span) < kSlowest * static_cast<double>(n)) return;
  throw std::runtime_error(
      name + ": " + std::to_string(n) + " events in " + DecimalSeconds(span) +
      " s: the unit of the stamps is another one; name it in the head (t_us, t_ms, t_ns), or "
      "write seconds with six decimals");
}

void RequireDistinctStamps(const std::string& name, std::int64_t n, std::int64_t n_stamps) {
  constexpr std::int64_t kFew = 1000, kStamps = 10;
  if (n < kFew || n_stamps > kStamps) return;
  throw std::runtime_error(
      name + ": its " + std::to_string(n) + " events have only " + std::to_string(n_stamps) +
      " different stamps: were they rounded, as 32-bit floats of seconds since 1970 are? "
      "Write them as integers or 64-bit floats");
}

void CheckImu(const ImportStreams& streams, Utime first_event) {
  if (streams.imu_name.empty()) return;
  if (streams.imu.size() < 2) throw std::runtime_error(streams.imu_name + ": holds no IMU samples");
  for (std::size_t k = 1; k < streams.imu.size(); ++k)
    CheckHole(streams.imu_name, streams.imu[k - 1].t, streams.imu[k].t);
  if (streams.imu.back().t >= first_event) return;
  throw std::runtime_error(streams.imu_name + ": ends before the first event" +
                           OtherClock(streams.imu.back().t, first_event));
}

void CheckImuBegins(const ImportStreams& streams, Utime first_event, Utime last_event) {
  if (streams.imu_name.empty() || streams.imu.front().t <= last_event) return;
  throw std::runtime_error(streams.imu_name + ": begins after the last event" +
                           OtherClock(streams.imu.front().t, first_event));
}

void CheckTruth(const std::string& name, const TimeSpan& truth, Utime first, Utime last) {
  if (truth.first <= last && truth.second >= first) return;
  throw std::runtime_error((name.empty() ? "ground truth" : name) +
                           ": none of its poses is of the time of the events (poses " +
                           DecimalSeconds(truth.first) + " to " + DecimalSeconds(truth.second) +
                           " s, events " + DecimalSeconds(first) + " to " + DecimalSeconds(last) +
                           " s): it is of another sequence or clock; give the right one with --truth FILE, "
                           "or --truth none");
}

void PutInOrder(ImportStreams* streams) {
  TimeOrderOptions strict;
  strict.strict = true;
  const auto put = [&](auto* list, const std::string& name, DropCounts* dropped, const char* what) {
    TimeOrderCounts counts;
    const auto same = [&](const auto& s) { return s.t == list->front().t; };
    if (list->size() > 2 && std::all_of(list->begin(), list->end(), same))
      throw std::runtime_error(name + ": all " + what + " have the same stamp, " +
                               DecimalSeconds(list->front().t) +
                               " s: the program that recorded them must fill in the time (header.stamp)");
    *list = InTimeOrder(*list, strict, &counts);
    dropped->Add(counts);
    RequireMostKept(name, *dropped, static_cast<std::int64_t>(list->size()), what);
  };
  put(&streams->imu, streams->imu_name, &streams->dropped_imu, "IMU samples");
  put(&streams->truth, "ground truth", &streams->dropped_truth, "truth poses");
}

void CheckUnits(const ImportTarget& target, ImportStreams* streams) {
  for (ImuSample& s : streams->imu) {
    s.accel *= target.accel_scale;
    s.gyro *= target.gyro_scale;
  }
  const std::string complaint = target.any_imu ? "" : ImuComplaint(streams->imu);
  if (complaint.empty()) return;
  throw std::runtime_error(streams->imu_name + ": " + complaint +
                           "; --accel-unit and --gyro-unit convert, --any-imu takes it as it is");
}

}  // namespace evit::formats
