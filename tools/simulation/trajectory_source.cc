#include "tools/simulation/trajectory_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "tools/simulation/random.h"

namespace evit {
namespace {

constexpr Utime kMargin = 300'000;  // of poses beyond the clip, so that the spline's ends are well supported
constexpr double kDegrees = 57.29577951308232;

// y up -> z up: a quarter turn about x.
SE3 ZUpFromYUp() { return {ExpSO3(Eigen::Vector3d(1.5707963267948966, 0, 0)), Eigen::Vector3d::Zero()}; }

// Sums of sines with random phases, in about 0.2 to 1.2 Hz times `speed`.
class Wave {
 public:
  Wave(Random* random, double speed) {
    for (Part& part : parts_) {
      part.frequency = speed * random->Uniform(0.15, 0.75) * 6.2832;
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

Trajectory MakeBuiltin(bool fast, double duration, const Rig& rig) {
  Random random(fast ? 2 : 1, 0xB1);
  const double speed = fast ? 0.8 : 0.15, rate = fast ? 1.5 : 0.4, tempo = fast ? 1.6 : 0.7;
  std::vector<Wave> waves;
  waves.reserve(6);
  for (int i = 0; i < 6; ++i) waves.emplace_back(&random, tempo);
  const double step = 0.005, end = duration + 2 * ToSeconds(kMargin);
  // First of unit size, then scaled to the wanted mean speed and rate.
  const auto position = [&](double t) {
    return Eigen::Vector3d(waves[0](t), waves[1](t), 0.6 * waves[2](t));
  };
  const auto turn = [&](double t) {
    return Eigen::Vector3d(0.7 * waves[3](t), waves[4](t), 0.5 * waves[5](t));
  };
  double path = 0, angle = 0;
  for (double t = 0; t < end; t += step) {
    path += (position(t + step) - position(t)).norm();
    angle += LogSO3(ExpSO3(turn(t)).conjugate() * ExpSO3(turn(t + step))).norm();
  }
  const double scale_p = speed * end / path, scale_r = rate * end / angle;
  Eigen::Matrix3d R_map_camera;  // looks along +x, level
  R_map_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const SE3 T_camera_body = rig.T_body_camera.Inverse();
  Trajectory poses;
  for (int i = 0; i * step <= end; ++i) {
    const double t = i * step;
    const SE3 T_map_camera(Eigen::Quaterniond(R_map_camera) * ExpSO3(scale_r * turn(t)),
                           scale_p * position(t));
    poses.push_back(
        {1'642'661'138'000'000 + static_cast<Utime>(std::llround(t * 1e6)), T_map_camera * T_camera_body});
  }
  return poses;
}

// How much the poses look like a camera held by hand: upright, level, 0.5 to 2.5 m over the floor. Each alone
// is not enough: on VECtor's files the wrong frame can be as upright, on others as level, as the right one.
double HandHeldScore(const Trajectory& poses, const SE3& left, const SE3& right) {
  double up = 0, roll = 0, height = 0;
  for (const StampedPose& pose : poses) {
    const SE3 T_map_camera = left * pose.pose * right;
    up -= (T_map_camera.q * Eigen::Vector3d::UnitY()).z();
    roll += std::abs((T_map_camera.q * Eigen::Vector3d::UnitX()).z());
    height += T_map_camera.p.z();
  }
  const auto n = static_cast<double>(poses.size());
  return (up - roll) / n - (height / n < 0.5 || height / n > 2.5 ? 1 : 0);
}

// Makes T_world_body, z up, of whatever the file holds.
std::string ToBody(TrajectoryFrame frame, const Rig& rig, Trajectory* poses) {
  const double body = HandHeldScore(*poses, SE3(), rig.T_body_camera);
  const double marker = HandHeldScore(*poses, ZUpFromYUp(), rig.T_marker_body * rig.T_body_camera);
  std::ostringstream note;
  if (frame == TrajectoryFrame::kAuto) {
    frame = marker > body ? TrajectoryFrame::kMarkerYUp : TrajectoryFrame::kBody;
    note << std::fixed << std::setprecision(2)
         << "frame chosen by itself (upright, level, hand-held height: marker-yup " << marker << ", body "
         << body << "); ";
  }
  const bool is_marker = frame == TrajectoryFrame::kMarkerYUp;
  note << "poses read as " << (is_marker ? "marker-yup" : "body");
  if (is_marker) {
    for (StampedPose& pose : *poses) pose.pose = ZUpFromYUp() * pose.pose * rig.T_marker_body;
  }
  return note.str();
}

}  // namespace

Motion LoadMotion(const TrajectorySettings& settings, const Rig& rig) {
  Motion motion;
  Trajectory poses;
  const std::string builtin = "builtin:";
  if (settings.source.rfind(builtin, 0) == 0) {
    motion.name = settings.source.substr(builtin.size());
    if (motion.name != "handheld" && motion.name != "fast") {
      throw std::runtime_error("unknown trajectory '" + settings.source +
                               "': builtin:handheld or builtin:fast");
    }
    if (!(settings.duration_s >= 0.5 && settings.duration_s <= 600)) {
      throw std::runtime_error("duration must be 0.5 to 600 s");
    }
    poses = MakeBuiltin(motion.name == "fast", settings.duration_s, rig);
    motion.note = "made by formula";
    motion.begin = poses.front().t + kMargin;
    motion.end = motion.begin + static_cast<Utime>(std::llround(settings.duration_s * 1e6));
  } else {
    poses = ReadTum(settings.source);
    if (poses.size() < 20) throw std::runtime_error(settings.source + ": too few poses for a motion");
    motion.name = std::filesystem::path(settings.source).stem().string();
    motion.note = ToBody(settings.frame, rig, &poses);
    const Utime first = poses.front().t, last = poses.back().t;
    motion.begin = first + static_cast<Utime>(std::llround(settings.begin_s * 1e6));
    motion.end = settings.end_s > settings.begin_s
                     ? first + static_cast<Utime>(std::llround(settings.end_s * 1e6))
                     : last;
    if (motion.begin < first || motion.end > last || motion.end - motion.begin < 500'000) {
      std::ostringstream message;
      message << settings.source << ": cannot cut out " << settings.begin_s << ":" << settings.end_s
              << " s; the file has 0:" << ToSeconds(last - first) << " s, a sequence needs 0.5 s";
      throw std::runtime_error(message.str());
    }
    poses.erase(std::remove_if(poses.begin(), poses.end(),
                               [&](const StampedPose& p) {
                                 return p.t < motion.begin - kMargin || p.t > motion.end + kMargin;
                               }),
                poses.end());
  }
  motion.spline = PoseSpline::Fit(poses, settings.knot_ms * 1e-3);
  motion.begin = std::max(motion.begin, motion.spline.begin());
  motion.end = std::min(motion.end, motion.spline.end());
  for (const StampedPose& pose : poses) {
    const SE3 fitted = motion.spline.Pose(pose.t);
    motion.fit_rms_m += (fitted.p - pose.pose.p).squaredNorm();
    motion.fit_rms_deg += std::pow(kDegrees * AngularDistance(fitted.q, pose.pose.q), 2);
  }
  motion.fit_rms_m = std::sqrt(motion.fit_rms_m / static_cast<double>(poses.size()));
  motion.fit_rms_deg = std::sqrt(motion.fit_rms_deg / static_cast<double>(poses.size()));
  return motion;
}

void PlaceInRoom(const Rig& rig, const Scene& scene, Motion* motion) {
  constexpr Utime kStep = 20'000;
  Eigen::Vector3d look = Eigen::Vector3d::Zero();
  for (Utime t = motion->begin; t <= motion->end; t += kStep) {
    look += (motion->spline.Pose(t) * rig.T_body_camera).q * Eigen::Vector3d::UnitZ();
  }
  const double yaw = std::atan2(look.y(), look.x());
  motion->spline = motion->spline.Moved({ExpSO3(Eigen::Vector3d(0, 0, -yaw)), Eigen::Vector3d::Zero()});
  Eigen::AlignedBox3d box;
  for (Utime t = motion->begin; t <= motion->end; t += kStep) {
    box.extend((motion->spline.Pose(t) * rig.T_body_camera).p);
  }
  if ((box.sizes().array() > scene.free_space.sizes().array()).any()) {
    std::ostringstream message;
    message << "the camera's path is " << box.sizes().transpose() << " m large; the room has "
            << scene.free_space.sizes().transpose()
            << " m of free space: choose a shorter part with --seconds";
    throw std::runtime_error(message.str());
  }
  Eigen::Vector3d centre = scene.free_space.center();
  centre.z() = std::clamp(1.35, scene.free_space.min().z() + 0.5 * box.sizes().z(),
                          scene.free_space.max().z() - 0.5 * box.sizes().z());
  motion->spline = motion->spline.Moved({Eigen::Quaterniond::Identity(), centre - box.center()});
}

}  // namespace evit
