#include "tools/run/run_results.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "common/localization/place_index_file.h"
#include "common/text/format_text.h"
#include "common/text/words.h"
#include "tools/pictures/consistency_plot.h"
#include "tools/pictures/run_plot.h"
#include "tools/run/report_writer.h"
#include "tools/run/run_verdict.h"

namespace evit::run {
namespace {

constexpr double kAbsurdNees = 25;  // of a degree of freedom: five sigma are no matter of the covariance
constexpr double kLateStart = 0.5;  // s: a first pose after that is worth telling

// Only what was played counts: an interrupted run has seen a part.
double PlayedSeconds(const RunInputs& inputs, const Recorder& recorder, const RunOutcome& outcome) {
  const Utime end = outcome.ended == "finished" ? inputs.end : std::max(inputs.begin, recorder.mode().utime);
  return ToSeconds(end - inputs.begin);
}

void Describe(const RunJob& job, const RunInputs& inputs, report::Report* report) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  report->set_command(job.command);
  report->set_host(host);
  report->set_rig(job.rig);
  report->set_map(job.map.empty() ? job.photometric_map : job.map);
  report->set_log(job.log);
  report->set_config(inputs.settings);
  report->set_lossless(job.play.lossless);
  report->set_begin_utime(static_cast<double>(inputs.begin));
  report->set_end_utime(static_cast<double>(inputs.end));
  report->set_events(static_cast<double>(inputs.n_events));
  report->set_event_rate_per_s(static_cast<double>(inputs.n_events) / ToSeconds(inputs.end - inputs.begin));
}

// Rates and cost, once keyframes and services are in.
void FillRates(const Pipeline& pipeline, const RunOutcome& outcome, report::Report* report) {
  const double sequence = report->sequence_s();
  report->set_ended(outcome.ended);
  report->set_wall_s(outcome.wall_s);
  report->set_real_time_factor(sequence / outcome.wall_s);
  if (sequence > 0) report->set_keyframe_rate_hz(static_cast<double>(report->keyframes()) / sequence);
  double cpu = 0;
  for (const auto& process : pipeline.processes()) cpu += process->cpu_seconds();
  if (report->keyframes() > 0) {
    report->set_cpu_ms_per_keyframe(1e3 * cpu / static_cast<double>(report->keyframes()));
  }
  report->set_service_restarts(static_cast<std::int32_t>(pipeline.deaths().size()));
}

void FillRestarts(const Pipeline& pipeline, const RunOutcome& outcome, report::Report* report) {
  const std::vector<Pipeline::Death>& deaths = pipeline.deaths();
  for (std::size_t k = 0; k < deaths.size(); ++k) {
    const auto until = k + 1 < deaths.size() ? deaths[k + 1].at : outcome.end;
    report::Restart* restart = report->add_restarts();
    restart->set_service(deaths[k].service);
    restart->set_at_s(std::chrono::duration<double>(deaths[k].at - outcome.begin).count());
    restart->set_ms_without_poses(outcome.outages->MsAfter(deaths[k].at, until));
    restart->set_keyframes_lost(
        static_cast<double>(outcome.outages->KeyframesLostAfter(deaths[k].at, until)));
  }
}

void Fill(const LatencyProbe::Summary& summary, report::Latency* out) {
  out->set_count(summary.count);
  out->set_p50_ms(summary.p50_ms);
  out->set_p99_ms(summary.p99_ms);
  out->set_max_ms(summary.max_ms);
}

void FillLatency(const LatencyProbe& probe, report::Report* report) {
  Fill(probe.pose_after_events(), report->mutable_pose_after_events());
  Fill(probe.pose_after_stamp(), report->mutable_pose_after_stamp());
  Fill(probe.imu_pose(), report->mutable_imu_pose());
}

void PrintLatency(const report::Report& report) {
  const auto row = [](const char* what, const report::Latency& l) {
    std::printf("latency: %s p50 %.1f ms, p99 %.1f ms, at most %.1f ms\n", what, l.p50_ms(), l.p99_ms(),
                l.max_ms());
  };
  row("pose after its last event", report.pose_after_events());
  row("pose after its instant   ", report.pose_after_stamp());
  row("IMU-rate pose            ", report.imu_pose());
}

// `poses`: those that were scored.
std::string Title(const RunJob& job, const report::Report& report, const Trajectory& poses) {
  std::string name = std::filesystem::path(job.log).stem().string();
  if (poses.empty()) return name + ": no pose";
  const double share = 100 * TrackedShare(poses, report.sequence_s());
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
  return name + text + (first > kLateStart ? FormatText(", first pose after %.1f s", first) : "");
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

// A picture that cannot be written costs no result: what is there is kept, and it is said.
template <typename Plot>
bool Draw(const Plot& plot) {
  try {
    plot();
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "evit run: %s\n", error.what());
    return false;
  }
}

}  // namespace

int WriteResults(const RunJob& job, const RunInputs& inputs, const Recorder& recorder,
                 const Pipeline& pipeline, const RunOutcome& outcome) {
  report::Report report;
  Describe(job, inputs, &report);
  for (const auto& process : pipeline.processes()) {
    report::Service* service = report.add_services();
    service->set_name(process->command().id);
    service->set_cpu_s(process->cpu_seconds());
    service->set_peak_memory_mb(process->peak_mb());
  }
  FillFromRecorder(recorder, &report);
  report.set_sequence_s(PlayedSeconds(inputs, recorder, outcome));
  FillRates(pipeline, outcome, &report);
  FillRestarts(pipeline, outcome, &report);
  if (outcome.latency != nullptr) FillLatency(*outcome.latency, &report);
  const Trajectory& online = recorder.online();
  Consistency consistency;
  if (!inputs.truth.empty() && !online.empty()) {
    FillErrors(inputs.truth, online, &report);
    consistency = ConsistencyOf(inputs.truth, online, recorder.covariances());
    FillConsistency(consistency, &report);
  }

  WriteTum(job.out + "/trajectory.tum", online);
  WriteTum(job.out + "/smoothed.tum", recorder.smoothed());
  WriteCovariances(job.out + "/covariance.csv", recorder.covariances());
  WriteReport(job.out + "/report.json", report);
  const std::string title = Title(job, report, online);
  bool drawn = Draw([&] { pictures::PlotRun(job.out + "/trajectory.png", title, inputs.truth, online); });

  std::printf("%s\n", title.c_str());
  if (!report.not_scored().empty()) std::printf("%s\n", report.not_scored().c_str());
  const bool scored = !consistency.errors.empty();
  if (scored) {
    const std::string text = ConsistencyText(consistency);
    drawn =
        Draw([&] { pictures::PlotConsistency(job.out + "/consistency.png", text, consistency); }) && drawn;
    std::printf("%s\n", text.c_str());
    if (consistency.pose.median > kAbsurdNees * consistency.pose.dof) {
      std::printf(
          "that is far more than what the poses know of themselves: are the truth's poses those of the IMU, "
          "in "
          "the map's frame? evit doctor --log %s --map %s --rig %s --truth %s says\n",
          job.log.c_str(), job.map.c_str(), job.rig.c_str(), job.truth.c_str());
    }
  }
  std::printf("%d keyframes (%.0f Hz), %.1f s in %.1f s: real-time factor %.2f; %.1f ms CPU per keyframe\n",
              report.keyframes(), report.keyframe_rate_hz(), report.sequence_s(), report.wall_s(),
              report.real_time_factor(), report.cpu_ms_per_keyframe());
  if (outcome.latency != nullptr) PrintLatency(report);
  std::printf("%s, services restarted %zu times\n", LossText(report).c_str(), pipeline.deaths().size());
  const Untimely untimely = UntimelyOf(report);
  if (untimely.events + untimely.imu > 0)
    std::printf("left out for their stamps (too late, or far ahead): %.0f events, %.0f IMU samples\n",
                untimely.events, untimely.imu);
  if (inputs.lost_bytes > 0)
    std::printf("the log was cut off: its last %lld bytes are no whole message and were not played\n",
                static_cast<long long>(inputs.lost_bytes));
  std::printf("results: %s/{trajectory.tum,smoothed.tum,covariance.csv,report.json,trajectory.png%s}\n",
              job.out.c_str(), scored ? ",consistency.png" : "");
  const std::string places = PlaceIndexPath(job.map);
  if (!inputs.start && std::filesystem::exists(places))
    std::printf("the map's places, kept for the next start without a pose: %s\n", places.c_str());
  std::fflush(stdout);
  const std::string failure =
      FailureOf(report, report.keyframes() == 0 ? StatusText(recorder) : recorder.mode().reason,
                TrackedShare(online, report.sequence_s()), untimely);
  if (!failure.empty()) std::fprintf(stderr, "evit run: %s\n", failure.c_str());
  if (outcome.ended == "interrupted") return 130;
  if (!failure.empty()) return 2;
  if (!drawn) return 1;
  return !job.tolerate.no_score && report.ate().empty() ? 3 : 0;
}

}  // namespace evit::run
