// A recording tracked from many starts, frame builder and tracker in one process: seconds where `evit run`
// takes minutes, for trials of a change. scripts/trial starts it.
// Usage: tracking_trial LOG MAP RIG TRUTH SETTINGS OFF LENGTH START...
// START: seconds after the truth's first pose; each run begins there, CM and DEG (OFF is "CM:DEG") off the
// true pose in random directions, and is LENGTH seconds long (0: to the end). One Markdown row for each on
// standard output, of all poses reported; "TRACKING after": the first pose of the window; "apart": what two
// runs that follow each other differ by at the same instants, once both are half a second old. Exit code 1
// where a pose said to be TRACKING is more than 5 cm off, or a run that starts from the true pose is lost.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/evaluation/consistency.h"
#include "common/evaluation/trajectory_error.h"
#include "common/events/keyframe_builder.h"
#include "common/geometry/degrees.h"
#include "common/map/denoise.h"
#include "common/map/map_file.h"
#include "common/map/map_index.h"
#include "common/tracking/feedback.h"
#include "common/tracking/map_tracker.h"
#include "tools/calibration/recorded_events.h"
#include "tools/calibration/recorded_motion.h"

namespace evit {
namespace {

Utime ToUtime(double seconds) { return std::llround(1e6 * seconds); }

PointMap ServedMap(const std::string& path) {
  PointMap map = LoadMap(path).map;
  Denoise(DenoiseSettingsFor(map, Summarize(map).median_spacing), &map);
  return map;
}

struct Recording {
  std::string log;
  MapIndex map;
  Rig rig;
  Trajectory truth;
  PipelineOptions options;
  std::vector<ImuSample> imu;
};

class Run {
 public:
  /// From `begin` to `end` (us), the body at T_map_body at first.
  Run(const Recording& recording, const SE3& T_map_body, Utime begin, Utime end)
      : recording_(recording), builder_(recording.rig, DrawingOf(recording.options), /*lossless=*/true) {
    tracker_ = MakeTracker(recording.rig, TrackerPart(recording.options), T_map_body);
    auto sample = recording.imu.begin();
    while (sample != recording.imu.end() && sample->t < begin) ++sample;
    calibration::ForEachEventPacket(recording.log, begin, end, [this, &sample](const EventArray& events) {
      // Some IMU ahead, as in a log: keyframes wait for it.
      constexpr Utime kAhead = 20'000;
      for (; sample != recording_.imu.end() && sample->t <= events.t.back() + kAhead; ++sample)
        builder_.AddImu(*sample);
      builder_.AddEvents(events, events.t.back());
      Track();
    });
    builder_.Flush();
    Track();
  }

  bool tracks() const { return last_.mode == TrackerMode::kTracking && tracking_.size() > 5; }
  /// Said TRACKING where it was not.
  bool wrong() const {
    return tracking_.size() > 2 &&
           AbsoluteError(recording_.truth, tracking_, Alignment::kNone).position_max > 0.05;
  }
  TrajectoryError error() const { return AbsoluteError(recording_.truth, poses_, Alignment::kNone); }
  const Trajectory& poses() const { return poses_; }
  const Trajectory& tracking() const { return tracking_; }
  Consistency consistency() const { return ConsistencyOf(recording_.truth, poses_, covariances_); }

 private:
  static KeyframeBuilder::Options DrawingOf(const PipelineOptions& options) {
    return {options.keyframes, options.surface, Keyframe::Encoding::kTimeSurface};
  }

  void Track() {
    while (const auto keyframe = builder_.Next()) {
      const KeyframeInput input = InputOf(*keyframe);
      if (!answered_ || !tracker_->Suffices(*answered_, tracker_->QueryAfter(input))) Ask(input);
      last_ = tracker_->Process(input);
      builder_.SetFeedbackFor(keyframe->seq, FeedbackOf(last_));
      if (!last_.has_pose) continue;
      poses_.push_back({keyframe->utime, last_.nodes.back().state.T_map_body});
      if (last_.mode == TrackerMode::kTracking) tracking_.push_back(poses_.back());
      covariances_.push_back({keyframe->utime, last_.covariance});
    }
  }

  void Ask(const KeyframeInput& input) {
    answered_ = tracker_->QueryBeyond(input);
    const VisibilityAnswer seen = recording_.map.Query(*answered_);
    std::vector<Eigen::Vector3f> points;
    for (const std::int32_t id : seen.ids)
      points.push_back(recording_.map.map().points[static_cast<std::size_t>(id)]);
    tracker_->AddVisible(seen.ids, points);
  }

  const Recording& recording_;
  KeyframeBuilder builder_;
  std::unique_ptr<MapTracker> tracker_;
  std::optional<VisibilityQuery> answered_;
  TrackerOutput last_;
  Trajectory poses_, tracking_;  // all, and those of the window
  Covariances covariances_;
};

// Of the runs that hold.
struct Sums {
  int n = 0, lost = 0, wrong = 0;
  double first = 0, tracks = 0, position = 0, orientation = 0, largest = 0;
  double log_position_nees = 0, log_orientation_nees = 0;
  Trajectory before;  // poses of the last run
  int n_apart = 0;
  double position_apart = 0, orientation_apart = 0;

  void Add(double first_pose, double first_tracking, const TrajectoryError& error,
           const Consistency& consistency) {
    ++n;
    first = std::max(first, first_pose), tracks = std::max(tracks, first_tracking);
    position += std::pow(error.position_rmse, 2), orientation += std::pow(error.orientation_rmse, 2);
    log_position_nees += std::log(consistency.position.mean_per_dof());
    log_orientation_nees += std::log(consistency.orientation.mean_per_dof());
    largest = std::max(largest, error.position_max);
  }

  void Compare(const Trajectory& poses) {
    Trajectory settled;
    for (const StampedPose& pose : poses)
      if (pose.t > poses.front().t + 500'000) settled.push_back(pose);
    const TrajectoryError apart = AbsoluteError(before, settled, Alignment::kNone);
    before = settled;
    if (!apart.scored()) return;
    ++n_apart;
    position_apart += std::pow(apart.position_rmse, 2);
    orientation_apart += std::pow(apart.orientation_rmse, 2);
  }

  void Print() const {
    const double k = std::max(n, 1), pairs = std::max(n_apart, 1);
    std::printf(
        "| **all** | %.2f | %.2f | %.3f / %.3f | %.2f / %.2f | %.2f, %.2f | %.2f | %d lost, %d wrong, of %d "
        "|\n",
        first, tracks, 100 * std::sqrt(position / k), kDegreesPerRadian * std::sqrt(orientation / k),
        100 * std::sqrt(position_apart / pairs), kDegreesPerRadian * std::sqrt(orientation_apart / pairs),
        std::exp(log_position_nees / k), std::exp(log_orientation_nees / k), 100 * largest, lost, wrong,
        n + lost + wrong);
  }
};

struct Off {
  double position = 0, rotation = 0;  // m, rad

  SE3 From(const SE3& T_map_body, std::mt19937* chance) const {
    std::normal_distribution<double> axis;
    const auto direction = [&] {
      return Eigen::Vector3d(axis(*chance), axis(*chance), axis(*chance)).normalized();
    };
    return {T_map_body.q * ExpSO3(rotation * direction()), T_map_body.p + position * direction()};
  }
};

void Try(const Recording& recording, const std::string& start, double length, const Off& off, Sums* sums) {
  const Utime first = recording.truth.front().t, begin = first + ToUtime(std::strtod(start.c_str(), nullptr));
  const Utime end = length > 0 ? begin + ToUtime(length) : recording.truth.back().t;
  SE3 T_map_body;
  if (!PoseAt(recording.truth, begin, &T_map_body)) throw std::runtime_error(start + " is outside the truth");
  std::mt19937 chance(static_cast<unsigned>(begin - first));
  const Run run(recording, off.From(T_map_body, &chance), begin, end);
  const auto after = [begin](const Trajectory& poses) {
    return poses.empty() ? 0 : ToSeconds(poses.front().t - begin);
  };
  const TrajectoryError error = run.error();
  const Consistency consistency = run.consistency();
  const bool wrong = run.wrong();
  std::printf("| %s | %.2f | %.2f | %.3f / %.3f | | %.2f, %.2f | %.2f | %s |\n", start.c_str(),
              after(run.poses()), after(run.tracking()), 100 * error.position_rmse,
              kDegreesPerRadian * error.orientation_rmse, consistency.position.mean_per_dof(),
              consistency.orientation.mean_per_dof(), 100 * error.position_max,
              wrong          ? "WRONG"
              : run.tracks() ? "TRACKING"
                             : "LOST");
  std::fflush(stdout);
  if (wrong) {
    ++sums->wrong;
  } else if (!run.tracks()) {
    ++sums->lost;
  } else {
    sums->Add(after(run.poses()), after(run.tracking()), error, consistency);
    sums->Compare(run.poses());
  }
}

int Main(int n, char** argument) {
  const Rig rig = LoadRig(argument[3]);
  const Recording recording{argument[1],
                            MapIndex(ServedMap(argument[2])),
                            rig,
                            ReadTum(argument[4]),
                            LoadOptionsFor(rig.camera, argument[5]),
                            calibration::ReadImu(argument[1], rig.imu_noise)};
  if (recording.options.method == PipelineOptions::Method::kEvpt)
    throw std::runtime_error(std::string(argument[5]) + ": no trial of EVPT, which has another map");
  Off off;
  if (std::sscanf(argument[6], "%lf:%lf", &off.position, &off.rotation) != 2)
    throw std::runtime_error(std::string(argument[6]) + ": no CM:DEG");
  off.position /= 100, off.rotation *= kRadiansPerDegree;
  std::printf(
      "| start, s | first pose, s | TRACKING after, s | ATE cm / deg | apart cm / deg | "
      "NEES/dof position, orientation | largest cm | end |\n|---|---|---|---|---|---|---|---|\n");
  Sums sums;
  for (int k = 8; k < n; ++k) Try(recording, argument[k], std::strtod(argument[7], nullptr), off, &sums);
  sums.Print();
  return sums.wrong > 0 || (off.position == 0 && sums.lost > 0) ? 1 : 0;
}

}  // namespace
}  // namespace evit

int main(int argc, char** argv) try {
  if (argc > 8) return evit::Main(argc, argv);
  std::fprintf(stderr, "usage: tracking_trial LOG MAP RIG TRUTH SETTINGS CM:DEG LENGTH START...\n");
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "tracking_trial: %s\n", error.what());
  return 2;
}
