#include "tools/run/tracked_time.h"

#include <algorithm>

namespace evit::run {
namespace {

constexpr Utime kTogether = 500'000;  // us: poses come at least this often, in slow motion too

}  // namespace

std::vector<Untracked> UntrackedSpans(const report::Report& report) {
  std::vector<Untracked> spans;
  bool tracked = false, open = false;  // tracked: a start that takes several attempts is no loss
  Utime last = 0;
  for (const report::ModeChange& change : report.mode_changes()) {
    const auto t = static_cast<Utime>(change.utime());
    if (open && t < last) {  // the log was played again, or the clock went back
      spans.back().end = last;
      open = tracked = false;
    }
    last = t;
    if (change.mode() == "TRACKING") {
      if (open) spans.back().end = t;
      tracked = true, open = false;
      continue;
    }
    if (!tracked) continue;
    if (!open) spans.push_back({t, t, false, change.reason()});
    open = true;
    if (change.mode() == "LOST" && !spans.back().lost)
      spans.back().lost = true, spans.back().reason = change.reason();
  }
  if (open) spans.back().end = std::max(last, static_cast<Utime>(report.end_utime()));
  return spans;
}

std::vector<Utime> BreaksOf(const Trajectory& poses, const std::vector<Untracked>& untracked) {
  std::vector<Utime> breaks;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const Utime from = poses[k - 1].t, to = poses[k].t;
    const bool between = std::any_of(untracked.begin(), untracked.end(), [&](const Untracked& span) {
      return span.begin <= to && span.end > from;
    });
    if (between || to - from > kTogether) breaks.push_back(to);
  }
  return breaks;
}

double Coverage(const Trajectory& poses, const std::vector<Utime>& breaks, double seconds) {
  Utime covered = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    if (!std::binary_search(breaks.begin(), breaks.end(), poses[k].t)) covered += poses[k].t - poses[k - 1].t;
  }
  return seconds > 0 ? std::min(1.0, ToSeconds(covered) / seconds) : 0;
}

std::vector<Utime> BreaksOf(const Trajectory& poses, int loops, const report::Report& report) {
  return BreaksOf(poses, loops > 1 ? std::vector<Untracked>() : UntrackedSpans(report));
}

void FillTrackedTime(const Trajectory& poses, int loops, report::Report* report) {
  const std::vector<Untracked> spans = UntrackedSpans(*report);
  int times = 0;
  Utime lost = 0;
  for (const Untracked& span : spans) {
    if (!span.lost) continue;
    ++times;
    lost += span.end - span.begin;
    report->set_last_loss(span.reason);
  }
  report->set_times_lost(times);
  const double seconds = report->sequence_s();
  if (seconds > 0) report->set_lost_share(std::min(1.0, ToSeconds(lost) / (seconds * std::max(1, loops))));
  report->set_coverage(Coverage(poses, BreaksOf(poses, loops, *report), seconds));
}

}  // namespace evit::run
