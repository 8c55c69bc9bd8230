#include "tools/run/run_results.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "tools/pictures/consistency_plot.h"
#include "tools/pictures/run_plot.h"
#include "tools/run/report_writer.h"
#include "tools/run/run_summary.h"
#include "tools/run/run_verdict.h"
#include "tools/run/tracked_time.h"

namespace evit::run {
namespace {

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

report::Report MakeReport(const RunJob& job, const RunInputs& inputs, const Recorder& recorder,
                          const Pipeline& pipeline, const RunOutcome& outcome) {
  report::Report report;
  Describe(job, inputs, &report);
  for (const auto& process : pipeline.processes()) {
    report::Service* service = report.add_services();
    service->set_name(process->command().id);
    service->set_cpu_s(process->cpu_seconds());
    service->set_peak_memory_mb(process->peak_mb());
  }
  FillFromRecorder(recorder, inputs.log_begin, &report);
  report.set_sequence_s(PlayedSeconds(inputs, recorder, outcome));
  FillTrackedTime(recorder.online(), job.play.loops, &report);
  FillRates(pipeline, outcome, &report);
  FillRestarts(pipeline, outcome, &report);
  if (outcome.latency != nullptr) FillLatency(*outcome.latency, &report);
  return report;
}

}  // namespace

int WriteResults(const RunJob& job, const RunInputs& inputs, const Recorder& recorder,
                 const Pipeline& pipeline, const RunOutcome& outcome) {
  report::Report report = MakeReport(job, inputs, recorder, pipeline, outcome);
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
  const std::string title = RunTitle(job, report, online);
  const std::vector<Utime> breaks = BreaksOf(online, job.play.loops, report);
  const pictures::TimeAxis time{inputs.log_begin, inputs.begin, inputs.end};
  bool drawn = Draw(
      [&] { pictures::PlotRun(job.out + "/trajectory.png", title, inputs.truth, online, time, breaks); });
  if (!consistency.errors.empty()) {
    drawn &= Draw([&] {
      pictures::PlotConsistency(job.out + "/consistency.png", ConsistencyText(consistency), consistency, time,
                                breaks);
    });
  }
  PrintSummary(job, inputs, report, title, consistency, outcome.latency != nullptr);

  const std::string failure = FailureOf(
      report, report.keyframes() == 0 ? StatusText(recorder) : recorder.mode().reason, UntimelyOf(report));
  if (!failure.empty()) std::fprintf(stderr, "evit run: %s\n", failure.c_str());
  if (outcome.ended == "interrupted") return 130;
  if (!failure.empty()) return 2;
  if (!drawn) return 1;
  return !job.tolerate.no_score && report.ate().empty() ? 3 : 0;
}

}  // namespace evit::run
