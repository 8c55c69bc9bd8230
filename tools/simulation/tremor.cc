#include "tools/simulation/tremor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/simulation/random.h"

namespace evit::simulation {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kSines = 3;

// A vector that shakes: over time the RMS of its length is 1 / sqrt(2).
class Shake {
 public:
  Shake(Random* random, double hz) {
    // No axis is without: shares between 0.4 and 1, in a random direction otherwise.
    Eigen::Vector3d share;
    for (int axis = 0; axis < 3; ++axis) share[axis] = random->Uniform(0.4, 1);
    share.normalize();
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < kSines; ++k) {
        Sine& sine = sines_[axis * kSines + k];
        // One in each third of the band, so that they beat.
        sine.omega = kTwoPi * hz * random->Uniform(0.85 + 0.1 * k, 0.95 + 0.1 * k);
        sine.phase = random->Uniform(0, kTwoPi);
        sine.amplitude = share[axis] / std::sqrt(static_cast<double>(kSines));
      }
    }
  }
  Eigen::Vector3d operator()(double t) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3 * kSines; ++i) {
      sum[i / kSines] += sines_[i].amplitude * std::sin(sines_[i].omega * t + sines_[i].phase);
    }
    return sum;
  }

 private:
  struct Sine {
    double omega, phase, amplitude;
  };
  std::array<Sine, 3 * kSines> sines_;
};

}  // namespace

PoseSpline AddTremor(const PoseSpline& motion, const Tremor& tremor, double knot_spacing,
                     std::uint64_t seed) {
  Random random(seed, 0x73E3);
  const Shake translation(&random, tremor.hz), rotation(&random, tremor.hz);
  // Ten knots for each period of the fastest sine, and four poses for each knot: nothing of it is smoothed
  // away.
  constexpr double kKnotsPerPeriod = 10, kPosesPerKnot = 4, kFastest = 1.15;
  const double knot = std::min(knot_spacing, 1 / (kKnotsPerPeriod * kFastest * tremor.hz));
  const auto step = std::max<Utime>(100, static_cast<Utime>(1e6 * knot / kPosesPerKnot));
  Trajectory poses;
  for (Utime t = motion.begin(); t <= motion.end(); t += step) {
    const double s = ToSeconds(t - motion.begin());
    const SE3 shaken(ExpSO3(tremor.deg * kTwoPi / 360 * rotation(s)), 1e-3 * tremor.mm * translation(s));
    poses.push_back({t, motion.Pose(t) * shaken});
  }
  return PoseSpline::Fit(poses, knot);
}

}  // namespace evit::simulation
