#include "tools/simulation/trajectory_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tools/simulation/builtin_motion.h"

namespace evit::simulation {
namespace {

constexpr Utime kMargin = 300'000;  // of poses beyond the clip, so that the spline's ends are well supported
constexpr double kDegrees = 57.29577951308232;
constexpr double kPi = 3.14159265358979;

// y up -> z up: a quarter turn about x.
SE3 ZUpFromYUp() { return {ExpSO3(Eigen::Vector3d(1.5707963267948966, 0, 0)), Eigen::Vector3d::Zero()}; }

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

// Makes T_map_body, z up, of whatever the file holds.
std::string ToBody(TrajectoryFrame frame, const Rig& rig, Trajectory* poses) {
  const double body = HandHeldScore(*poses, SE3(), rig.T_body_camera);
  const double marker = HandHeldScore(*poses, ZUpFromYUp(), rig.T_marker_body * rig.T_body_camera);
  std::ostringstream note;
  if (frame == TrajectoryFrame::kAuto) {
    frame = marker > body ? TrajectoryFrame::kMarkerYUp : TrajectoryFrame::kBody;
    note << std::fixed << std::setprecision(2)
         << "frame detected (upright, level, hand-held height: marker-yup " << marker << ", body "
         << body << "); ";
  }
  const bool is_marker = frame == TrajectoryFrame::kMarkerYUp;
  note << "poses read as " << (is_marker ? "marker-yup" : "body");
  if (is_marker) {
    for (StampedPose& pose : *poses) pose.pose = ZUpFromYUp() * pose.pose * rig.T_marker_body;
  }
  return note.str();
}

// Sets begin and end, and leaves only the poses of that part with a margin around it.
void CutOut(const TrajectorySettings& settings, Trajectory* poses, Motion* motion) {
  const Utime first = poses->front().t, last = poses->back().t;
  motion->begin = first + static_cast<Utime>(std::llround(settings.begin_s * 1e6));
  motion->end = settings.end_s > settings.begin_s
                    ? first + static_cast<Utime>(std::llround(settings.end_s * 1e6))
                    : last;
  if (motion->begin < first || motion->end > last || motion->end - motion->begin < 500'000) {
    std::ostringstream message;
    message << settings.source << ": cannot cut out " << settings.begin_s << ":" << settings.end_s
            << " s; the file has 0:" << ToSeconds(last - first) << " s, a sequence needs 0.5 s";
    throw std::runtime_error(message.str());
  }
  const auto margin = static_cast<Utime>(static_cast<double>(kMargin) * std::max(1.0, settings.play_speed));
  poses->erase(std::remove_if(poses->begin(), poses->end(),
                              [&](const StampedPose& p) {
                                return p.t < motion->begin - margin || p.t > motion->end + margin;
                              }),
               poses->end());
}

// The same way in 1 / speed of the time, from the first pose that is left.
void PlayFaster(double speed, Trajectory* poses, Motion* motion) {
  const Utime origin = poses->front().t;
  const auto played = [&](Utime t) {
    return origin + static_cast<Utime>(std::llround(static_cast<double>(t - origin) / speed));
  };
  for (StampedPose& pose : *poses) pose.t = played(pose.t);
  motion->begin = played(motion->begin);
  motion->end = played(motion->end);
}

void MeasureFit(const Trajectory& poses, Motion* motion) {
  for (const StampedPose& pose : poses) {
    const SE3 fitted = motion->spline.Pose(pose.t);
    motion->fit_rms_m += (fitted.p - pose.pose.p).squaredNorm();
    motion->fit_rms_deg += std::pow(kDegrees * AngularDistance(fitted.q, pose.pose.q), 2);
  }
  motion->fit_rms_m = std::sqrt(motion->fit_rms_m / static_cast<double>(poses.size()));
  motion->fit_rms_deg = std::sqrt(motion->fit_rms_deg / static_cast<double>(poses.size()));
}

// Moves the path's middle to `centre`, or as near to it as the free space allows.
void Centre(const Eigen::AlignedBox3d& path, const Eigen::AlignedBox3d& free_space, Eigen::Vector3d centre,
            Motion* motion) {
  const Eigen::Vector3d half = 0.5 * path.sizes();
  centre = centre.cwiseMax(free_space.min() + half).cwiseMin(free_space.max() - half);
  motion->spline = motion->spline.Moved({Eigen::Quaterniond::Identity(), centre - path.center()});
}

}  // namespace

Motion LoadMotion(const TrajectorySettings& settings, const Rig& rig) {
  Motion motion;
  Trajectory poses;
  if (!(settings.play_speed >= 0.1 && settings.play_speed <= 20))
    throw std::runtime_error("play speed must be 0.1 to 20");
  const std::string builtin = "builtin:";
  if (settings.source.rfind(builtin, 0) == 0) {
    motion.name = settings.source.substr(builtin.size());
    const BuiltinMotion* formula = FindBuiltinMotion(motion.name);
    if (formula == nullptr) {
      throw std::runtime_error("unknown trajectory '" + settings.source + "': a TUM file, or one of " +
                               BuiltinMotionNames());
    }
    if (!(settings.duration_s >= 0.5 && settings.duration_s <= 600)) {
      throw std::runtime_error("duration must be 0.5 to 600 s");
    }
    if (settings.variant < 1) throw std::runtime_error("variants of builtin motions count from 1");
    // Played faster, it takes more of the formula to fill the time.
    const double length = settings.duration_s * settings.play_speed;
    poses = MakeBuiltinMotion(*formula, length, settings.variant, rig);
    motion.note = "made by formula";
    motion.at_desk = formula->at_desk;
    motion.begin = poses.front().t + kMargin;
    motion.end = motion.begin + static_cast<Utime>(std::llround(length * 1e6));
  } else {
    poses = ReadTum(settings.source);
    if (poses.size() < 20) throw std::runtime_error(settings.source + ": too few poses for a motion");
    motion.name = std::filesystem::path(settings.source).stem().string();
    motion.note = ToBody(settings.frame, rig, &poses);
    CutOut(settings, &poses, &motion);
  }
  if (settings.play_speed != 1) PlayFaster(settings.play_speed, &poses, &motion);
  const double knot = settings.knot_ms * 1e-3;
  motion.spline = PoseSpline::Fit(poses, knot);
  motion.begin = std::max(motion.begin, motion.spline.begin());
  motion.end = std::min(motion.end, motion.spline.end());
  MeasureFit(poses, &motion);
  const Tremor& tremor = settings.tremor;
  if (tremor.hz != 0 || tremor.mm != 0 || tremor.deg != 0) {
    if (!(tremor.hz >= 0.5 && tremor.hz <= 30 && tremor.mm >= 0 && tremor.mm <= 50 && tremor.deg >= 0 &&
          tremor.deg <= 10)) {
      throw std::runtime_error("tremor must be 0.5 to 30 Hz, 0 to 50 mm and 0 to 10 degrees");
    }
    motion.spline = AddTremor(motion.spline, tremor, knot, settings.tremor_seed);
    motion.end = std::min(motion.end, motion.spline.end());
  }
  return motion;
}

void PlaceInRoom(const Rig& rig, const Scene& scene, Motion* motion) {
  constexpr Utime kStep = 20'000;
  Eigen::Vector3d look = Eigen::Vector3d::Zero();
  for (Utime t = motion->begin; t <= motion->end; t += kStep) {
    look += (motion->spline.Pose(t) * rig.T_body_camera).q * Eigen::Vector3d::UnitZ();
  }
  double yaw = std::atan2(look.y(), look.x());
  if (motion->at_desk) yaw -= 0.5 * kPi;  // the desk is towards +y
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
  if (motion->at_desk) {
    Centre(box, scene.free_space, scene.desk + Eigen::Vector3d(0, -0.75, 0.65), motion);
    return;
  }
  Eigen::Vector3d centre = scene.free_space.center();
  centre.z() = std::clamp(1.35, scene.free_space.min().z() + 0.5 * box.sizes().z(),
                          scene.free_space.max().z() - 0.5 * box.sizes().z());
  motion->spline = motion->spline.Moved({Eigen::Quaterniond::Identity(), centre - box.center()});
}

MotionSpeed MeasureMotionSpeed(const Motion& motion, const Rig& rig) {
  std::vector<double> speeds, rates;
  for (Utime t = motion.begin; t <= motion.end; t += 5000) {
    const PoseSpline::Sample state = motion.spline.Evaluate(t);
    const Eigen::Vector3d arm = rig.T_body_camera.p;
    speeds.push_back((state.velocity + state.pose.q * state.rate.cross(arm)).norm());
    rates.push_back(state.rate.norm());
  }
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  const auto p99 = [](std::vector<double>* v) {
    const auto at = v->begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(v->size()));
    std::nth_element(v->begin(), at, v->end());
    return *at;
  };
  return {mean(speeds), p99(&speeds), mean(rates), p99(&rates)};
}

}  // namespace evit::simulation
