#include "tools/formats/import/import_log.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "common/files/staged_file.h"
#include "tools/formats/import/import_checks.h"
#include "tools/formats/import/ordered_events.h"
#include "tools/formats/import/stream_writer.h"

namespace evit::formats {
namespace {

constexpr Utime kNoEnd = std::numeric_limits<Utime>::max();

template <typename List>
void Clip(List* list, Utime begin, Utime end) {
  list->erase(
      std::remove_if(list->begin(), list->end(), [&](const auto& s) { return s.t < begin || s.t > end; }),
      list->end());
}

double Rate(const std::vector<ImuSample>& imu) {
  if (imu.size() < 2) return 0;
  return static_cast<double>(imu.size() - 1) / ToSeconds(imu.back().t - imu.front().t);
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

// One import, from the first event to the summary.
class Import {
 public:
  Import(const ImportTarget& target, EventSource* source, ImportStreams streams)
      : target_(target), events_(source), streams_(std::move(streams)) {}

  ImportSummary Run(const std::function<void(double)>& progress);

 private:
  bool has_imu() const { return !streams_.imu_name.empty(); }
  void ReadFirst();
  void ChoosePart();
  void WriteEvents(StreamWriter* writer, const std::function<void(double)>& progress);
  bool WritePiece(StreamWriter* writer);
  void CheckStamps();
  void CheckWhole() const;
  ImportSummary Summary(std::int64_t n_packets) const;

  const ImportTarget& target_;
  OrderedEvents events_;
  ImportStreams streams_;
  EventArray piece_;
  Utime first_ = 0, last_ = 0;      // events; the last so far
  Utime begin_ = 0, end_ = kNoEnd;  // of the part that is taken
  std::optional<TimeSpan> truth_;   // when it begins and ends, before the part is cut out
  std::int64_t n_read_ = 0, n_stamps_ = 1, n_events_ = 0;  // events read, different stamps, events written
};

void Import::ReadFirst() {
  if (!events_.Read(&piece_)) {
    const std::string dropped = DropText(events_.dropped(), "events");
    throw std::runtime_error(events_.name() + ": holds no event" + (dropped.empty() ? "" : "; " + dropped));
  }
  first_ = last_ = piece_.t.front();
}

void Import::ChoosePart() {
  begin_ = has_imu() ? std::min(first_, streams_.imu.front().t) : first_;
  if (target_.seconds) {
    begin_ = first_ + static_cast<Utime>(target_.seconds->first * 1e6);
    end_ = first_ + static_cast<Utime>(target_.seconds->second * 1e6);
  }
  if (!streams_.truth.empty()) truth_ = {streams_.truth.front().t, streams_.truth.back().t};
  Clip(&streams_.imu, begin_, end_);
  Clip(&streams_.truth, begin_, end_);
  if (has_imu() && streams_.imu.size() < 2)
    throw std::runtime_error("the part asked for by --seconds holds no IMU samples");
}

// Of the piece, as far as the part goes.
void Import::CheckStamps() {
  const std::string name = events_.name();
  n_read_ += static_cast<std::int64_t>(piece_.size());
  CheckRate(name, n_read_, piece_.t.back() - first_);
  Utime last = last_;
  for (std::size_t k = 0; k < piece_.size() && last <= end_; ++k) {
    CheckHole(name, last, piece_.t[k]);
    n_stamps_ += piece_.t[k] != last ? 1 : 0;
    last = piece_.t[k];
  }
}

// False where the part ends within the piece.
bool Import::WritePiece(StreamWriter* writer) {
  const auto at = [&](Utime t) {
    return static_cast<std::size_t>(std::lower_bound(piece_.t.begin(), piece_.t.end(), t) - piece_.t.begin());
  };
  const std::size_t from = at(begin_), to = end_ == kNoEnd ? piece_.size() : at(end_ + 1);
  if (from < to) {
    writer->AddEvents(piece_, from, to);
    n_events_ += static_cast<std::int64_t>(to - from);
  }
  if (to > 0) last_ = piece_.t[to - 1];
  return to == piece_.size();
}

void Import::WriteEvents(StreamWriter* writer, const std::function<void(double)>& progress) {
  bool more = true;
  while (more) {
    CheckStamps();
    more = WritePiece(writer);
    progress(target_.seconds ? static_cast<double>(last_ - begin_) / static_cast<double>(end_ - begin_)
                             : events_.share());
    more = more && events_.Read(&piece_);
  }
}

// What only shows in the end.
void Import::CheckWhole() const {
  RequireMostKept(events_.name(), events_.dropped(), n_read_, "events");
  RequireDistinctStamps(events_.name(), n_read_, n_stamps_);
  if (n_events_ == 0) throw std::runtime_error("the part asked for by --seconds holds no events");
  CheckImuBegins(streams_, first_, last_);
  if (truth_) CheckTruth(streams_.truth_name, *truth_, first_, last_);
}

ImportSummary Import::Summary(std::int64_t n_packets) const {
  ImportSummary summary;
  summary.n_events = n_events_;
  summary.n_packets = n_packets;
  summary.n_imu = static_cast<std::int64_t>(streams_.imu.size());
  summary.n_truth = static_cast<std::int64_t>(streams_.truth.size());
  summary.seconds = ToSeconds(last_ - begin_);
  summary.first_event = std::max(first_, begin_);
  summary.last_event = last_;
  summary.imu_rate_hz = Rate(streams_.imu);
  if (has_imu()) {
    const Utime first = std::max(begin_, streams_.imu.front().t),
                last = std::min(last_, streams_.imu.back().t);
    summary.imu_covers_s = std::max(0.0, ToSeconds(last - first));
  }
  summary.dropped_events = events_.dropped();
  summary.dropped_imu = streams_.dropped_imu;
  summary.dropped_truth = streams_.dropped_truth;
  return summary;
}

ImportSummary Import::Run(const std::function<void(double)>& progress) {
  PutInOrder(&streams_);
  CheckUnits(target_, &streams_);
  ReadFirst();
  CheckImu(streams_, first_);
  ChoosePart();
  StagedFile log(target_.out);
  std::int64_t n_packets = 0;
  {
    StreamWriter writer(log.part(), begin_, streams_.imu, streams_.truth);
    WriteEvents(&writer, progress);
    CheckWhole();
    writer.Close(has_imu() ? std::max(last_, streams_.imu.back().t) : last_);
    n_packets = writer.n_packets();
  }
  progress(1);  // may be interrupted, which nothing behind it may
  PutInPlace(&log, target_.out, streams_.truth);
  return Summary(n_packets);
}

}  // namespace

ImportSummary ImportLog(const ImportTarget& target, EventSource* events, ImportStreams streams,
                        const std::function<void(double)>& progress) {
  return Import(target, events, std::move(streams)).Run(progress);
}

}  // namespace evit::formats
