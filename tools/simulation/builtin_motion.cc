#include "tools/simulation/builtin_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/geometry/degrees.h"
#include "tools/simulation/random.h"

namespace evit::simulation {
namespace {

// Speeds and rates of VECtor's recordings where known: robot_normal 0.12 m/s and 0.3 rad/s; sofa_fast 0.84
// m/s, at the 99th percentile 1.7 m/s and 3.4 rad/s.
constexpr std::array<BuiltinMotion, 9> kMotions{{
    {"handheld", 1, 0.15, 0.4, 0.7, 0.7, {1, 1, 0.6}, {0.7, 1, 0.5}, 0, false},
    {"fast", 2, 0.8, 1.5, 1.6, 1.6, {1, 1, 0.6}, {0.7, 1, 0.5}, 0, false},
    {"rotation", 3, 0.06, 1.0, 1.2, 1.0, {1, 1, 0.7}, {0.6, 1, 0.5}, 0, false},
    {"desk_normal", 4, 0.18, 0.45, 0.7, 0.8, {0.6, 1, 0.6}, {0.7, 1, 0.8}, 38, true},
    {"desk_fast", 5, 0.6, 1.5, 1.7, 1.7, {0.7, 1, 0.7}, {0.7, 0.9, 0.9}, 38, true},
    {"sofa_normal", 6, 0.22, 0.5, 0.6, 0.7, {0.9, 1, 0.5}, {0.6, 1, 0.4}, 12, false},
    {"sofa_fast", 7, 0.84, 1.5, 1.6, 1.8, {0.9, 1, 0.5}, {0.7, 1, 0.5}, 12, false},
    {"robot_normal", 8, 0.12, 0.3, 0.6, 0.6, {1, 0.9, 0.3}, {0.4, 1, 0.2}, 5, false},
    {"robot_fast", 9, 0.75, 1.4, 1.6, 1.6, {1, 0.9, 0.5}, {0.6, 1, 0.4}, 5, false},
}};

constexpr int kStep = 5000;       // us between poses
constexpr double kMarginS = 0.3;  // of poses at both ends, beyond what is asked for

// Sums of sines with random phases.
class Wave {
 public:
  Wave(Random* random, double tempo) {
    for (Part& part : parts_) {
      part.frequency = tempo * random->Uniform(0.15, 0.75) * 6.2832;
      part.phase = random->Uniform(0, 6.2832);
      part.amplitude = 1 / part.frequency;
    }
  }
  double operator()(double t) const {
    double sum = 0;
    for (const Part& part : parts_) sum += part.amplitude * std::sin(part.frequency * t + part.phase);
    return sum;
  }

 private:
  struct Part {
    double frequency, phase, amplitude;
  };
  Part parts_[3];
};

Trajectory Draw(const BuiltinMotion& b, double duration, Random random, const Rig& rig) {
  std::vector<Wave> waves;
  waves.reserve(6);
  for (int i = 0; i < 6; ++i) waves.emplace_back(&random, i < 3 ? b.tempo : b.turn_tempo);
  const double step = 1e-6 * kStep, end = duration + 2 * kMarginS;
  // First of unit size, then scaled to the specified mean speed and rate.
  const auto position = [&](double t) {
    return Eigen::Vector3d(b.path_weight[0] * waves[0](t), b.path_weight[1] * waves[1](t),
                           b.path_weight[2] * waves[2](t));
  };
  const auto turn = [&](double t) {
    return Eigen::Vector3d(b.turn_weight[0] * waves[3](t), b.turn_weight[1] * waves[4](t),
                           b.turn_weight[2] * waves[5](t));
  };
  double path = 0, angle = 0;
  for (double t = 0; t < end; t += step) {
    path += (position(t + step) - position(t)).norm();
    angle += LogSO3(ExpSO3(turn(t)).conjugate() * ExpSO3(turn(t + step))).norm();
  }
  const double scale_p = b.speed * end / path, scale_r = b.rate * end / angle;
  Eigen::Matrix3d R_map_camera;  // looks along +x, level
  R_map_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Quaterniond rest(R_map_camera);
  if (b.pitch_deg != 0) rest = rest * ExpSO3(Eigen::Vector3d(-b.pitch_deg * kRadiansPerDegree, 0, 0));
  const SE3 T_camera_body = rig.T_body_camera.Inverse();
  Trajectory poses;
  for (int i = 0; i * step <= end; ++i) {
    const double t = i * step;
    const SE3 T_map_camera(rest * ExpSO3(scale_r * turn(t)), scale_p * position(t));
    poses.push_back(
        {1'642'661'138'000'000 + static_cast<Utime>(std::llround(t * 1e6)), T_map_camera * T_camera_body});
  }
  return poses;
}

// Fits into a room's free space of 2 x 2.4 x 1.3 m, however it is turned a little to look straight on.
bool FitsARoom(const Trajectory& poses, const Rig& rig) {
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : poses) box.extend((pose.pose * rig.T_body_camera).p);
  return (box.sizes().array() < Eigen::Array3d(1.8, 2.1, 1.2)).all();
}

}  // namespace

const BuiltinMotion* FindBuiltinMotion(const std::string& name) {
  const auto* found =
      std::find_if(kMotions.begin(), kMotions.end(), [&](const BuiltinMotion& b) { return name == b.name; });
  return found == kMotions.end() ? nullptr : found;
}

std::string BuiltinMotionNames() {
  std::string names;
  for (const BuiltinMotion& b : kMotions)
    names += (names.empty() ? "builtin:" : ", builtin:") + std::string(b.name);
  return names;
}

Trajectory MakeBuiltinMotion(const BuiltinMotion& builtin, double duration, std::uint64_t variant,
                             const Rig& rig) {
  constexpr std::uint64_t kTries = 40;
  Trajectory poses;
  for (std::uint64_t i = 0; i < kTries; ++i) {
    poses = Draw(builtin, duration, Random(builtin.seed, 0xB1 + 0x10000 * (variant - 1) + 0x100 * i), rig);
    if (variant == 1 || FitsARoom(poses, rig)) break;
  }
  return poses;
}

}  // namespace evit::simulation
