#include "tools/run/report_writer.h"

#include <google/protobuf/util/json_util.h>

#include <stdexcept>

#include "common/evaluation/trajectory_error.h"
#include "common/evaluation/trajectory_pairs.h"
#include "common/files/whole_file.h"
#include "common/geometry/degrees.h"

namespace evit::run {
namespace {

void Fill(const TrajectoryError& error, report::Error* out) {
  out->set_pairs(error.n_pairs);
  out->set_position_rmse_cm(100 * error.position_rmse);
  out->set_orientation_rmse_deg(kDegreesPerRadian * error.orientation_rmse);
  out->set_position_max_cm(100 * error.position_max);
  out->set_orientation_max_deg(kDegreesPerRadian * error.orientation_max);
}

void Fill(const Nees& nees, report::Nees* out) {
  out->set_pairs(nees.n);
  out->set_dof(nees.dof);
  out->set_mean_per_dof(nees.mean_per_dof());
  out->set_mean(nees.mean);
  out->set_median(nees.median);
  out->set_share_within_95(nees.share_in_95);
}

const char* ModeName(int mode) {
  static constexpr const char* kNames[] = {"BOOTSTRAPPING", "TRACKING", "LOST"};
  return mode >= 0 && mode < 3 ? kNames[mode] : "?";
}

}  // namespace

void FillFromRecorder(const Recorder& recorder, Utime log_begin, report::Report* report) {
  report->set_keyframes(static_cast<std::int32_t>(recorder.n_keyframes()));
  report->set_poses(static_cast<std::int32_t>(recorder.online().size()));
  report->set_final_mode(recorder.n_keyframes() > 0 ? ModeName(recorder.mode().mode) : "no keyframe");
  report->set_mean_solve_ms(recorder.mean_solve_ms());
  for (const Recorder::ModeChange& change : recorder.mode_changes()) {
    report::ModeChange* out = report->add_mode_changes();
    out->set_seconds(ToSeconds(change.t - log_begin));
    out->set_mode(ModeName(change.mode));
    out->set_reason(change.reason);
    out->set_utime(static_cast<double>(change.t));
  }
  for (report::Service& service : *report->mutable_services()) {
    const auto it = recorder.statuses().find(service.name());
    if (it == recorder.statuses().end()) continue;
    const service_status_t& status = it->second;
    service.set_last_state(status.state);
    service.set_granted_receive_buffer(status.granted_receive_buffer);
    for (int k = 0; k < status.n_counters; ++k) {
      (*service.mutable_counters())[status.counter_name[k]] = static_cast<double>(status.counter_value[k]);
    }
    for (int k = 0; k < status.n_timings; ++k)
      (*service.mutable_mean_ms())[status.timing_name[k]] = status.timing_ms[k];
  }
}

void FillErrors(const Trajectory& truth, const Trajectory& estimate, report::Report* report) {
  const TrajectoryError whole = AbsoluteError(truth, estimate, Alignment::kNone);
  report->set_reached(whole.reached);
  report->set_not_scored(whole.scored() ? UnscoredText(truth, estimate) : TooFewPairsText(truth, estimate));
  for (const auto& row : {std::pair("none", Alignment::kNone), std::pair("first pair", Alignment::kFirstPair),
                          std::pair("umeyama", Alignment::kUmeyama)}) {
    const TrajectoryError all = AbsoluteError(truth, estimate, row.second);
    if (!all.scored() || !all.oriented) continue;
    report::Milestones* out = report->add_ate();
    out->set_alignment(row.first);
    Fill(all, out->mutable_all());
    const auto milestone = [&](double share) { return MilestoneError(truth, estimate, row.second, share); };
    if (const auto e = milestone(0.3); e.scored() && e.oriented) Fill(e, out->mutable_at_30_percent());
    if (const auto e = milestone(0.5); e.scored() && e.oriented) Fill(e, out->mutable_at_50_percent());
    if (const auto e = milestone(1.0); e.scored() && e.oriented) Fill(e, out->mutable_at_100_percent());
  }
}

void FillConsistency(const Consistency& consistency, report::Report* report) {
  report::Consistency* out = report->mutable_consistency();
  Fill(consistency.position, out->mutable_position_nees());
  Fill(consistency.orientation, out->mutable_orientation_nees());
  Fill(consistency.pose, out->mutable_pose_nees());
  out->set_poses_without_covariance(consistency.without_covariance);
}

void WriteReport(const std::string& path, const report::Report& report) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;  // a reader need not know that 0 is left out
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(report, &json, options);
  if (!status.ok()) throw std::runtime_error(path + ": " + status.ToString());
  WholeFile file(path);
  file.stream() << json;
  file.Commit();
}

}  // namespace evit::run
