#include "tools/run/run_summary.h"

#include <cstdio>
#include <filesystem>

#include "common/localization/place_index_file.h"
#include "common/text/format_text.h"
#include "common/text/words.h"

namespace evit::run {
namespace {

constexpr double kAbsurdNees = 25;  // of a degree of freedom: five sigma are not the covariance's fault
constexpr double kLateStart = 0.5;  // s: a first pose after that is worth telling

void PrintLatency(const report::Report& report) {
  const auto row = [](const char* what, const report::Latency& l) {
    std::printf("latency: %s p50 %.1f ms, p99 %.1f ms, at most %.1f ms\n", what, l.p50_ms(), l.p99_ms(),
                l.max_ms());
  };
  row("pose after its last event", report.pose_after_events());
  row("pose after its instant   ", report.pose_after_stamp());
  row("IMU-rate pose            ", report.imu_pose());
}

// The sum of the services' counters of which `is` says so.
template <typename Is>
double Sum(const report::Report& report, const Is& is) {
  double sum = 0;
  for (const report::Service& service : report.services()) {
    for (const auto& [name, value] : service.counters()) {
      if (is(name)) sum += value;
    }
  }
  return sum;
}

// Messages that a service noticed missing or had no time for. In lossless mode what got lost was sent again.
std::string LossText(const report::Report& report) {
  if (report.lossless()) return "lossless: every message arrived";
  const double lost = Sum(report, [](const std::string& name) {
    return name != "mode.lost" && (EndsWith(name, ".lost") || EndsWith(name, ".dropped"));
  });
  return FormatText("%.0f messages lost", lost);
}

std::string TimesText(int n) { return n == 1 ? "once" : std::to_string(n) + " times"; }

// What examines the recording, with all that it can use.
std::string DoctorCommand(const RunJob& job) {
  return "evit doctor --log " + job.log + " --rig " + job.rig + (job.map.empty() ? "" : " --map " + job.map) +
         (job.truth.empty() ? "" : " --truth " + job.truth);
}

// What to ask when errors are out of all proportion.
void PrintAbsurdity(const RunJob& job) {
  std::printf(
      "that is far more than what the poses know of themselves: are the truth's poses those of the IMU, in "
      "the map's frame? %s says\n",
      DoctorCommand(job).c_str());
}

}  // namespace

std::string LossesText(const RunJob& job, const report::Report& report) {
  if (report.times_lost() == 0) return "";
  return FormatText("LOST %s, %.0f %% of the time (last: %s); what may be wrong: %s",
                    TimesText(report.times_lost()).c_str(), 100 * report.lost_share(),
                    report.last_loss().c_str(), DoctorCommand(job).c_str());
}

std::string RunTitle(const RunJob& job, const report::Report& report, const Trajectory& poses) {
  std::string name = std::filesystem::path(job.log).stem().string();
  if (poses.empty()) return name + ": no pose";
  const double share = 100 * report.coverage();
  std::string text;
  if (report.ate().empty()) {
    text = FormatText(": %sposes for %.0f %% of the sequence",
                      report.not_scored().empty() ? "" : "no score, ", share);
  } else {
    const report::Error& all = report.ate(0).all();
    text = FormatText(": ATE %.2f cm, %.2f deg (map frame, no alignment), %.0f %% of the sequence",
                      all.position_rmse_cm(), all.orientation_rmse_deg(), share);
  }
  const double first = ToSeconds(poses.front().t - static_cast<Utime>(report.begin_utime()));
  if (first > kLateStart) text += FormatText(", first pose after %.1f s", first);
  return name + text + (report.times_lost() > 0 ? ", LOST " + TimesText(report.times_lost()) : "");
}

void PrintSummary(const RunJob& job, const RunInputs& inputs, const report::Report& report,
                  const std::string& title, const Consistency& consistency, bool latency) {
  std::printf("%s\n", title.c_str());
  if (report.times_lost() > 0) std::printf("%s\n", LossesText(job, report).c_str());
  if (!report.not_scored().empty()) std::printf("%s\n", report.not_scored().c_str());
  const bool scored = !consistency.errors.empty();
  if (scored) {
    std::printf("%s\n", ConsistencyText(consistency).c_str());
    if (consistency.pose.median > kAbsurdNees * consistency.pose.dof) PrintAbsurdity(job);
  }
  std::printf("%d keyframes (%.0f Hz), %.1f s in %.1f s: real-time factor %.2f; %.1f ms CPU per keyframe\n",
              report.keyframes(), report.keyframe_rate_hz(), report.sequence_s(), report.wall_s(),
              report.real_time_factor(), report.cpu_ms_per_keyframe());
  if (latency) PrintLatency(report);
  std::printf("%s, services restarted %d times\n", LossText(report).c_str(), report.service_restarts());
  const Untimely untimely = UntimelyOf(report);
  if (untimely.events + untimely.imu > 0)
    std::printf("left out for their stamps (too late, or far ahead): %.0f events, %.0f IMU samples\n",
                untimely.events, untimely.imu);
  if (inputs.lost_bytes > 0)
    std::printf("the log was cut off: its last %lld bytes are not a whole message and were not played\n",
                static_cast<long long>(inputs.lost_bytes));
  std::printf("results: %s/{trajectory.tum,smoothed.tum,covariance.csv,report.json,trajectory.png%s}\n",
              job.out.c_str(), scored ? ",consistency.png" : "");
  const std::string places = inputs.start ? "" : KeptPlaceIndexText(job.map);
  if (!places.empty())
    std::printf("the map's places, kept for the next start without a pose: %s\n", places.c_str());
  std::fflush(stdout);
}

}  // namespace evit::run
