#include "common/diagnosis/motion_check.h"

#include <algorithm>
#include <cmath>

#include "common/diagnosis/rising_samples.h"
#include "common/geometry/so3.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr Utime kMotionStep = 50'000;  // us
constexpr double kShortestMotion = 1;  // s
constexpr double kUsualDepth = 2;      // m: at which a speed turns the view as a rate does
constexpr double kSlowTurn = 0.075;    // rad/s: 20 pixels a second of a usual camera
constexpr double kVerySlowTurn = 0.035;
constexpr double kStillShake = 0.1;  // m/s^2

MeanMotion ByPoses(const Trajectory& truth, Utime begin, Utime end) {
  MeanMotion motion;
  double turning = 0, speed = 0;
  int n = 0;
  for (Utime t = begin; t + kMotionStep <= end; t += kMotionStep) {
    SE3 a, b;
    if (!PoseAt(truth, t, &a) || !PoseAt(truth, t + kMotionStep, &b)) continue;
    turning += LogSO3(a.q.conjugate() * b.q).squaredNorm(), speed += (b.p - a.p).squaredNorm(), ++n;
  }
  if (n == 0) return motion;
  motion.turning = std::sqrt(turning / n) / ToSeconds(kMotionStep);
  motion.speed = std::sqrt(speed / n) / ToSeconds(kMotionStep);
  motion.seconds = n * ToSeconds(kMotionStep);
  motion.by_poses = true;
  return motion;
}

// Without the gyro's mean, which may be its bias.
MeanMotion ByImu(const std::vector<ImuSample>& samples) {
  std::vector<Eigen::Vector3d> gyros, accels;
  for (std::size_t begin = 0; begin < samples.size();) {
    Eigen::Vector3d gyro = Eigen::Vector3d::Zero(), accel = Eigen::Vector3d::Zero();
    std::size_t end = begin;
    for (; end < samples.size() && samples[end].t < samples[begin].t + kMotionStep; ++end)
      gyro += samples[end].gyro, accel += samples[end].accel;
    gyros.push_back(gyro / static_cast<double>(end - begin));
    accels.push_back(accel / static_cast<double>(end - begin));
    begin = end;
  }
  const auto n = static_cast<double>(gyros.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& gyro : gyros) mean += gyro / n;
  MeanMotion motion;
  for (const Eigen::Vector3d& gyro : gyros) motion.turning += (gyro - mean).squaredNorm() / n;
  for (std::size_t k = 1; k < accels.size(); ++k)
    motion.shaking += (accels[k] - accels[k - 1]).squaredNorm() / n;
  motion.turning = std::sqrt(motion.turning), motion.shaking = std::sqrt(motion.shaking);
  motion.seconds = ToSeconds(samples.back().t - samples.front().t);
  return motion;
}

}  // namespace

MeanMotion MeasureMotion(const std::vector<ImuSample>& unordered, const Trajectory& truth) {
  const std::vector<ImuSample> samples = RisingSamples(unordered);
  if (samples.size() < 20) return {};
  if (truth.size() > 1) {
    const MeanMotion motion = ByPoses(truth, std::max(truth.front().t, samples.front().t),
                                      std::min(truth.back().t, samples.back().t));
    if (2 * motion.seconds > ToSeconds(samples.back().t - samples.front().t)) return motion;
  }
  return ByImu(samples);
}

Finding CheckMotion(const std::vector<ImuSample>& samples, const Trajectory& truth) {
  const MeanMotion m = MeasureMotion(samples, truth);
  if (m.seconds < kShortestMotion) return Good("motion", "too short to tell");
  const std::string figure =
      m.by_poses ? FormatText("turns at %.2g rad/s, moves at %.2g m/s (rms)", m.turning, m.speed)
                 : FormatText("turns at %.2g rad/s, accelerates by %.2g m/s^2 (rms)", m.turning, m.shaking);
  const double view = m.turning + m.speed / kUsualDepth;  // rad/s by which it moves, about
  const bool slow = view < kSlowTurn && m.shaking < kStillShake;
  if (!slow) return Good("motion", figure);
  return {"motion", view < kVerySlowTurn ? Severity::kError : Severity::kWarning, figure,
          "The motion is too slow: edges that hardly move make few events, of which noise is a large part.",
          "move the rig faster, a quarter of a metre or a quarter of a turn in a few seconds; a recording "
          "that only stands still cannot be tracked"};
}

}  // namespace evit::diagnosis
