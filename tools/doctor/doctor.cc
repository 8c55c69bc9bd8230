#include "tools/doctor/doctor.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/alignment/event_flow.h"
#include "common/config/rig_file.h"
#include "common/diagnosis/accel_axes.h"
#include "common/diagnosis/accel_scale.h"
#include "common/diagnosis/clock_checks.h"
#include "common/diagnosis/event_checks.h"
#include "common/diagnosis/imu_checks.h"
#include "common/diagnosis/map_checks.h"
#include "common/diagnosis/motion_check.h"
#include "common/diagnosis/overlap_checks.h"
#include "common/diagnosis/rig_checks.h"
#include "common/diagnosis/stamp_checks.h"
#include "common/diagnosis/truth_checks.h"
#include "common/evaluation/trajectory.h"
#include "common/map/map_file.h"
#include "common/text/format_text.h"
#include "tools/doctor/recorded_data.h"

namespace evit::doctor {
namespace {

using diagnosis::Finding;
using diagnosis::Findings;
using diagnosis::Severity;

constexpr int kExcerpts = 10;
constexpr Utime kReach = 130'000;  // us: the longest time offset that is tried, and half of a slice

// Instants spread over what events and truth have in common.
diagnosis::EventExcerpts Excerpts(const RecordedData& data, const Rig& rig, const Trajectory& truth,
                                  double seconds) {
  std::vector<Utime> instants;
  if (truth.size() > 1) {
    const Utime begin = std::max(data.begin(), truth.front().t - rig.camera_time_offset) + kReach;
    const Utime end = std::min({data.end(), truth.back().t - rig.camera_time_offset,
                                data.begin() + static_cast<Utime>(1e6 * seconds)}) -
                      kReach;
    for (int k = 0; k < kExcerpts && end > begin; ++k)
      instants.push_back(begin + (end - begin) * (Utime{2} * k + 1) / (Utime{2} * kExcerpts));
  }
  return {std::move(instants), kReach};
}

void Append(Findings* all, Findings more) {
  for (Finding& finding : more) all->push_back(std::move(finding));
}

bool AllGood(const Findings& findings) {
  return std::all_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::kGood; });
}

bool OnlyGravityIsWrong(const Findings& of_truth) {
  return std::all_of(of_truth.begin(), of_truth.end(),
                     [](const Finding& f) { return f.severity == Severity::kGood || f.check == "gravity"; });
}

Findings CheckLog(const RecordedData& data) {
  Findings found;
  if (data.malformed() > 0) {
    found.push_back({"log", Severity::kWarning,
                     FormatText("%lld messages not well-formed", static_cast<long long>(data.malformed())),
                     "Some messages of the log are damaged, or of another version of the types.",
                     "import or record it again"});
  }
  if (data.truncated()) {
    found.push_back({"log", Severity::kWarning, "the log ends in the middle of a message",
                     "The log was cut off.", "`evit run --allow-truncated` uses the complete messages"});
  }
  if (found.empty()) found.push_back(diagnosis::Good("log", "every message well-formed"));
  return found;
}

void CheckPlace(const Patient& patient, const Rig& rig, const Trajectory& truth,
                const std::vector<ImuSample>& imu, const diagnosis::EventExcerpts& excerpts,
                Findings* found) {
  PointMap points = LoadMap(patient.map).map;
  Append(found, diagnosis::CheckMap(points));
  if (found->back().severity == Severity::kError) return;
  const bool small = found->back().check == "map-size";
  const MapIndex map(std::move(points));
  std::optional<SE3> start = patient.start;
  std::optional<SE3> known;  // in a recording whose clocks agree
  SE3 pose;
  if (truth.size() > 1) {
    const Utime begin = imu.empty() ? truth.front().t : std::max(truth.front().t, imu.front().t);
    if (PoseAt(truth, begin, &pose)) known = pose;
  }
  if (!start) start = known;
  Findings at_truth;
  if (!excerpts.instants().empty()) at_truth = diagnosis::CheckOverlap(map, rig, truth, excerpts);
  // What would mend the overlap says more than that the start sees nothing.
  if (!at_truth.empty() && at_truth.front().severity != Severity::kGood) {
    Append(found, std::move(at_truth));
    if (!patient.start) return;
    at_truth.clear();
  }
  // That a small map has few points in view is no fault of a start that is the truth's.
  if (start && (patient.start || !small))
    Append(found, diagnosis::CheckStart(map, rig, *start, imu, patient.start ? known : std::nullopt));
  Append(found, std::move(at_truth));
}

}  // namespace

Findings Examine(const Patient& patient, const std::function<void(double)>& progress) {
  const Rig rig = LoadRig(patient.rig);
  TumSkipped skipped;
  const Trajectory truth = patient.truth.empty() ? Trajectory{} : ReadTum(patient.truth, &skipped);
  RecordedData data(patient.log);
  diagnosis::EventCensus events(rig.camera.width, rig.camera.height);
  diagnosis::EventExcerpts excerpts = Excerpts(data, rig, truth, patient.seconds);
  EventFlow flow(rig.camera.width, rig.camera.height);
  std::vector<ImuSample> imu;
  data.Read(patient.seconds,
            {[&](const EventArray& part) { events.Add(part), excerpts.Add(part), flow.Add(part); },
             [&](const std::vector<ImuSample>& part) { imu.insert(imu.end(), part.begin(), part.end()); },
             progress});
  // The more basic cause first: of findings that are equally bad the first one is what to mend.
  Findings found = CheckLog(data);
  Append(&found,
         diagnosis::CheckStamps(events, ToSeconds(data.end() - data.begin()), imu, data.imu_seconds(), rig));
  const Findings of_imu = diagnosis::CheckImu(imu, rig), of_truth = diagnosis::CheckTruth(truth, imu);
  found.push_back(diagnosis::CheckMotion(imu, AllGood(of_truth) ? truth : Trajectory{}));
  Append(&found, diagnosis::CheckEvents(events));
  Append(&found, of_imu);
  // The mean force of an IMU that is wrong otherwise says nothing.
  if (AllGood(of_imu) && AllGood(of_truth))
    found.push_back(diagnosis::CheckAccelScale(imu, truth, rig.gravity));
  if (AllGood(of_imu) && OnlyGravityIsWrong(of_truth))
    found.push_back(diagnosis::CheckAccelAxes(imu, truth, rig.gravity));
  Append(&found, diagnosis::CheckClocks(events, flow.samples(), imu, rig.camera_time_offset));
  Append(&found, diagnosis::CheckRig(rig));
  Append(&found, of_truth);
  if (skipped.rows > 0)
    found.push_back({"truth-order", Severity::kWarning, skipped.Text(patient.truth),
                     "Some rows of the truth cannot be used.",
                     "sort the file by time (sort -g); remove repeated rows"});
  if (!patient.map.empty()) CheckPlace(patient, rig, truth, imu, excerpts, &found);
  diagnosis::DropContradicted(&found);
  diagnosis::SortBySeverity(&found);
  return found;
}

std::string NotChecked(const Patient& patient) {
  const auto missing = [](const std::string& what, const char* option) { return what + " (" + option + ")"; };
  std::vector<std::string> all;
  if (patient.map.empty()) all.push_back(missing("the map", "--map FILE"));
  if (patient.truth.empty()) {
    all.push_back(missing(patient.map.empty()
                              ? "the clock and frame of known poses"
                              : "whether extrinsics, clocks and the map's frame put the map on the events",
                          "--truth TUM, known poses"));
  }
  if (!patient.map.empty() && patient.truth.empty() && !patient.start)
    all.push_back(missing("what the start sees", "--initial-pose"));
  std::string text;
  for (const std::string& one : all) text += (text.empty() ? "" : "; ") + one;
  return text;
}

}  // namespace evit::doctor
