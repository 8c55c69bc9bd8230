#include "common/diagnosis/gravity_consistency.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/diagnosis/rising_samples.h"
#include "common/diagnosis/signed_permutations.h"
#include "common/geometry/so3.h"

namespace evit::diagnosis {
namespace {

constexpr Utime kApart = 1'000'000, kHalf = 100'000, kStep = 250'000, kWhole = 5'000;  // us
constexpr std::size_t kMostPairs = 200;
constexpr double kDegree = 0.017453292519943295;

struct Interval {
  double seconds;
  Eigen::Vector3d gyro;  // mean
};

// From one instant to another: the mean specific force around both, and the gyro in between.
struct Pair {
  Eigen::Vector3d before, after;
  std::vector<Interval> between;
};

class Samples {
 public:
  explicit Samples(const std::vector<ImuSample>& samples) : samples_(samples) {}
  std::size_t At(Utime t) const {
    const auto it = std::lower_bound(samples_.begin(), samples_.end(), t,
                                     [](const ImuSample& s, Utime time) { return s.t < time; });
    return static_cast<std::size_t>(it - samples_.begin());
  }
  Eigen::Vector3d Force(Utime t) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = At(t - kHalf); k < samples_.size() && samples_[k].t <= t + kHalf; ++k)
      sum += samples_[k].accel;
    return sum.normalized();
  }
  std::vector<Interval> Between(Utime begin, Utime end) const {
    std::vector<Interval> all;
    Interval part{0, Eigen::Vector3d::Zero()};
    for (std::size_t k = At(begin); k + 1 < samples_.size() && samples_[k].t < end; ++k) {
      const double dt = ToSeconds(samples_[k + 1].t - samples_[k].t);
      part.gyro += dt * (samples_[k].gyro + samples_[k + 1].gyro) / 2;
      part.seconds += dt;
      if (part.seconds >= ToSeconds(kWhole)) {
        part.gyro /= part.seconds;
        all.push_back(part);
        part = {0, Eigen::Vector3d::Zero()};
      }
    }
    return all;
  }

 private:
  const std::vector<ImuSample>& samples_;
};

double Disagreement(const std::vector<Pair>& pairs, double scale, const Eigen::Matrix3d& axes) {
  std::vector<double> angles;
  for (const Pair& pair : pairs) {
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  // body at the second instant to body at the first
    for (const Interval& part : pair.between) q = q * ExpSO3(scale * part.seconds * (axes * part.gyro));
    const Eigen::Vector3d predicted = q.conjugate() * pair.before;
    angles.push_back(std::atan2(predicted.cross(pair.after).norm(), predicted.dot(pair.after)));
  }
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::nth_element(angles.begin(), middle, angles.end());
  return *middle;
}

}  // namespace

GyroFit FitGyroToGravity(const std::vector<ImuSample>& unordered) {
  GyroFit fit;
  const std::vector<ImuSample> ordered = RisingSamples(unordered);
  if (ordered.size() < 20) return fit;
  const Samples samples(ordered);
  std::vector<Pair> pairs;
  const Utime last = ordered.back().t - kApart - kHalf, first = ordered.front().t + kHalf;
  const Utime step = std::max(kStep, (last - first) / static_cast<Utime>(kMostPairs));
  for (Utime t = first; t <= last; t += step) {
    Pair pair{samples.Force(t), samples.Force(t + kApart), samples.Between(t, t + kApart)};
    if (pair.between.size() > 20) pairs.push_back(std::move(pair));
  }
  fit.pairs = static_cast<int>(pairs.size());
  if (pairs.empty()) return fit;
  fit.as_read = Disagreement(pairs, 1, Eigen::Matrix3d::Identity());
  fit.without = Disagreement(pairs, 0, Eigen::Matrix3d::Identity());
  fit.best = std::numeric_limits<double>::infinity();
  for (const double scale : {1.0, kDegree}) {
    for (const Eigen::Matrix3d& axes : SignedPermutations()) {
      // The gyro as it is, or in degrees, has to be beaten clearly by one with turned axes.
      const double handicap = axes.isIdentity() ? 1 : 1.3;
      const double angle = Disagreement(pairs, scale, axes);
      if (handicap * angle < fit.best) fit.best = handicap * angle, fit.scale = scale, fit.axes = axes;
    }
  }
  return fit;
}

}  // namespace evit::diagnosis
