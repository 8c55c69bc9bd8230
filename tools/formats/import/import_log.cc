#include "tools/formats/import/import_log.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "common/files/decimal_time.h"
#include "common/files/staged_file.h"
#include "common/imu/imu_plausibility.h"
#include "tools/formats/import/ordered_events.h"
#include "tools/formats/import/stream_writer.h"

namespace evit::formats {
namespace {

// A longer hole is a damaged time stamp, or two clocks: its silence would fill the log with empty packets.
constexpr Utime kMaxHole = 600 * kMicrosPerSecond;

template <typename List>
void Clip(List* list, Utime begin, Utime end) {
  list->erase(
      std::remove_if(list->begin(), list->end(), [&](const auto& s) { return s.t < begin || s.t > end; }),
      list->end());
}

void CheckHole(const std::string& name, Utime before, Utime after) {
  if (after - before <= kMaxHole) return;
  throw std::runtime_error(
      name + ": the time jumps from " + DecimalSeconds(before) + " s to " + DecimalSeconds(after) +
      " s: a damaged time stamp, or several recordings; import each recording separately");
}

// Stamps in the wrong unit would make a log of nothing but silence.
void CheckRate(const std::string& name, std::int64_t n, Utime span) {
  constexpr std::int64_t kFew = 1000;
  constexpr double kSlowest = 0.1;  // s an event
  if (n < kFew || ToSeconds(span) < kSlowest * static_cast<double>(n)) return;
  throw std::runtime_error(
      name + ": " + std::to_string(n) + " events in " + DecimalSeconds(span) +
      " s: the unit of the stamps is another one; name it in the head (t_us, t_ms, t_ns), or "
      "write seconds with six decimals");
}

// Stamps that were rounded away, as those since 1970 in 32-bit floats.
void RequireDistinctStamps(const std::string& name, std::int64_t n, std::int64_t n_stamps) {
  constexpr std::int64_t kFew = 1000, kStamps = 10;
  if (n < kFew || n_stamps > kStamps) return;
  throw std::runtime_error(
      name + ": its " + std::to_string(n) + " events have only " + std::to_string(n_stamps) +
      " different stamps: were they rounded, as 32-bit floats of seconds since 1970 are? "
      "Write them as integers or 64-bit floats");
}

double Rate(const std::vector<ImuSample>& imu) {
  if (imu.size() < 2) return 0;
  return static_cast<double>(imu.size() - 1) / ToSeconds(imu.back().t - imu.front().t);
}

std::string OtherClock(Utime imu, Utime first_event) {
  return " (IMU " + DecimalSeconds(imu) + " s, first event " + DecimalSeconds(first_event) +
         " s): the files are from different sequences or clocks; if the clocks, --imu-offset SECONDS is "
         "added to the "
         "IMU's stamps";
}

void CheckImu(const ImportStreams& streams, Utime first_event) {
  if (streams.imu_name.empty()) return;
  if (streams.imu.size() < 2) throw std::runtime_error(streams.imu_name + ": holds no IMU samples");
  for (std::size_t k = 1; k < streams.imu.size(); ++k)
    CheckHole(streams.imu_name, streams.imu[k - 1].t, streams.imu[k].t);
  if (streams.imu.back().t < first_event) {
    throw std::runtime_error(streams.imu_name + ": ends before the first event" +
                             OtherClock(streams.imu.back().t, first_event));
  }
}

// When the truth begins and ends.
using Span = std::optional<std::pair<Utime, Utime>>;

void CheckTruth(const std::string& name, const Span& truth, Utime first, Utime last) {
  if (!truth || (truth->first <= last && truth->second >= first)) return;
  throw std::runtime_error((name.empty() ? "ground truth" : name) +
                           ": none of its poses is of the time of the events (poses " +
                           DecimalSeconds(truth->first) + " to " + DecimalSeconds(truth->second) +
                           " s, events " + DecimalSeconds(first) + " to " + DecimalSeconds(last) +
                           " s): it is of another sequence or clock; give the right one with --truth FILE, "
                           "or --truth none");
}

// Samples and poses in order of time; too many that cannot be are an error.
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

// Scales to m/s^2 and rad/s, then refuses what still cannot be.
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

// Truth of an earlier import must not stay beside a log that has none, and goes only once the new log is in
// place.
void PutInPlace(StagedFile* log, const std::string& out, const Trajectory& truth) {
  const std::string truth_out = out + ".truth.tum";
  StagedFile staged(truth_out);
  if (!truth.empty()) WriteTum(staged.part(), truth);
  log->Commit();
  if (truth.empty()) {
    std::remove(truth_out.c_str());
  } else {
    staged.Commit();
  }
}

}  // namespace

ImportSummary ImportLog(const ImportTarget& target, EventSource* source, ImportStreams streams,
                        const std::function<void(double)>& progress) {
  PutInOrder(&streams);
  CheckUnits(target, &streams);
  OrderedEvents ordered(source);
  EventSource* const events = &ordered;
  EventArray piece;
  bool more = events->Read(&piece);
  if (!more) {
    const std::string dropped = DropText(events->dropped(), "events");
    throw std::runtime_error(events->name() + ": holds no event" + (dropped.empty() ? "" : "; " + dropped));
  }
  const Utime first = piece.t.front();
  CheckImu(streams, first);
  const bool has_imu = !streams.imu_name.empty();
  Utime begin = has_imu ? std::min(first, streams.imu.front().t) : first,
        end = std::numeric_limits<Utime>::max();
  if (target.seconds) {
    begin = first + static_cast<Utime>(target.seconds->first * 1e6);
    end = first + static_cast<Utime>(target.seconds->second * 1e6);
  }
  Clip(&streams.imu, begin, end);
  Span truth;
  if (!streams.truth.empty()) truth = {streams.truth.front().t, streams.truth.back().t};
  Clip(&streams.truth, begin, end);
  if (has_imu && streams.imu.size() < 2)
    throw std::runtime_error("the part asked for by --seconds holds no IMU samples");

  StagedFile log(target.out);
  ImportSummary summary;
  Utime last = first;
  std::int64_t n_read = 0, n_stamps = 1;
  {
    const std::string name = events->name();
    StreamWriter writer(log.part(), begin, streams.imu, streams.truth);
    for (; more; more = more && events->Read(&piece)) {
      n_read += static_cast<std::int64_t>(piece.size());
      const Utime before = last;
      CheckRate(name, n_read, piece.t.back() - first);
      for (std::size_t k = 0; k < piece.size() && last <= end; ++k) {
        CheckHole(name, last, piece.t[k]);
        n_stamps += piece.t[k] != last ? 1 : 0;
        last = piece.t[k];
      }
      const auto at = [&](Utime t) {
        return std::lower_bound(piece.t.begin(), piece.t.end(), t) - piece.t.begin();
      };
      const auto from = static_cast<std::size_t>(at(begin));
      const std::size_t to =
          end == std::numeric_limits<Utime>::max() ? piece.size() : static_cast<std::size_t>(at(end + 1));
      if (to < piece.size()) more = false;
      if (from < to) {
        writer.AddEvents(piece, from, to);
        summary.n_events += static_cast<std::int64_t>(to - from);
      }
      last = to > 0 ? piece.t[to - 1] : before;
      progress(target.seconds ? static_cast<double>(last - begin) / static_cast<double>(end - begin)
                              : events->share());
    }
    RequireMostKept(events->name(), events->dropped(), n_read, "events");
    RequireDistinctStamps(name, n_read, n_stamps);
    if (summary.n_events == 0) throw std::runtime_error("the part asked for by --seconds holds no events");
    if (has_imu && streams.imu.front().t > last) {
      throw std::runtime_error(streams.imu_name + ": begins after the last event" +
                               OtherClock(streams.imu.front().t, first));
    }
    CheckTruth(streams.truth_name, truth, first, last);
    writer.Close(has_imu ? std::max(last, streams.imu.back().t) : last);
    summary.n_packets = writer.n_packets();
  }
  PutInPlace(&log, target.out, streams.truth);
  summary.n_imu = static_cast<std::int64_t>(streams.imu.size());
  summary.n_truth = static_cast<std::int64_t>(streams.truth.size());
  summary.seconds = ToSeconds(last - begin);
  summary.first_event = std::max(first, begin);
  summary.last_event = last;
  summary.imu_rate_hz = Rate(streams.imu);
  summary.dropped_events = events->dropped();
  summary.dropped_imu = streams.dropped_imu;
  summary.dropped_truth = streams.dropped_truth;
  progress(1);
  return summary;
}

}  // namespace evit::formats
