#include "tools/simulation/load_motion.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "common/geometry/degrees.h"
#include "tools/simulation/builtin_motion.h"

namespace evit::simulation {

namespace {

constexpr Utime kMargin = 300'000;  // of poses beyond the clip, so that the spline's ends are well supported
constexpr char kBuiltin[] = "builtin:";

// Sets begin and end, and leaves only the poses of that part with a margin around it.
void CutOut(const MotionSettings& settings, Trajectory* poses, Motion* motion) {
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
    motion->fit_rms_deg += std::pow(kDegreesPerRadian * AngularDistance(fitted.q, pose.pose.q), 2);
  }
  motion->fit_rms_m = std::sqrt(motion->fit_rms_m / static_cast<double>(poses.size()));
  motion->fit_rms_deg = std::sqrt(motion->fit_rms_deg / static_cast<double>(poses.size()));
}

// A builtin motion's poses; sets what is known of it.
Trajectory MakeBuiltin(const MotionSettings& settings, const Rig& rig, Motion* motion) {
  motion->name = settings.source.substr(std::string(kBuiltin).size());
  const BuiltinMotion* formula = FindBuiltinMotion(motion->name);
  if (formula == nullptr) {
    throw std::runtime_error("--trajectory " + settings.source +
                             ": there is no such motion; a file of poses (TUM), or one of " +
                             BuiltinMotionNames());
  }
  if (!(settings.duration_s >= 0.5 && settings.duration_s <= 600)) {
    throw std::runtime_error("--duration must be 0.5 to 600 s");
  }
  if (settings.variant < 1) throw std::runtime_error("variants of builtin motions count from 1");
  // Played faster, it takes more of the formula to fill the time.
  const double length = settings.duration_s * settings.play_speed;
  Trajectory poses = MakeBuiltinMotion(*formula, length, settings.variant, rig);
  motion->note = "made by formula";
  motion->at_desk = formula->at_desk;
  motion->begin = poses.front().t + kMargin;
  motion->end = motion->begin + static_cast<Utime>(std::llround(length * 1e6));
  return poses;
}

// A file's poses of the part to simulate; sets what is known of it.
Trajectory ReadRecorded(const MotionSettings& settings, const Rig& rig, Motion* motion) {
  std::error_code error;
  if (!std::filesystem::exists(settings.source, error) && FindBuiltinMotion(settings.source) != nullptr)
    throw std::runtime_error("--trajectory " + settings.source + ": there is no such file; did you mean " +
                             kBuiltin + settings.source + "?");
  if (!std::filesystem::exists(settings.source, error))
    throw std::runtime_error("--trajectory " + settings.source +
                             ": there is no such file; a file of poses (TUM), or one of " +
                             BuiltinMotionNames());
  if (std::filesystem::is_directory(settings.source, error))
    throw std::runtime_error("--trajectory " + settings.source +
                             ": is a folder; give the file of poses in it");
  Trajectory poses = ReadTum(settings.source);
  if (poses.size() < 20) throw std::runtime_error(settings.source + ": too few poses for a motion");
  motion->name = std::filesystem::path(settings.source).stem().string();
  motion->note = ConvertToBody(settings.frame, rig, &poses);
  CutOut(settings, &poses, motion);
  return poses;
}

void Shake(const MotionSettings& settings, Motion* motion) {
  const Tremor& tremor = settings.tremor;
  if (tremor.hz == 0 && tremor.mm == 0 && tremor.deg == 0) return;
  if (!(tremor.hz >= 0.5 && tremor.hz <= 30 && tremor.mm >= 0 && tremor.mm <= 50 && tremor.deg >= 0 &&
        tremor.deg <= 10)) {
    throw std::runtime_error("tremor must be 0.5 to 30 Hz, 0 to 50 mm and 0 to 10 degrees");
  }
  motion->spline = AddTremor(motion->spline, tremor, settings.knot_ms * 1e-3, settings.tremor_seed);
  motion->end = std::min(motion->end, motion->spline.end());
}

}  // namespace

bool IsBuiltin(const MotionSettings& settings) { return settings.source.rfind(kBuiltin, 0) == 0; }

Motion LoadMotion(const MotionSettings& settings, const Rig& rig) {
  if (!(settings.play_speed >= 0.1 && settings.play_speed <= 20))
    throw std::runtime_error("--play-speed must be 0.1 to 20");
  Motion motion;
  Trajectory poses =
      IsBuiltin(settings) ? MakeBuiltin(settings, rig, &motion) : ReadRecorded(settings, rig, &motion);
  if (settings.play_speed != 1) PlayFaster(settings.play_speed, &poses, &motion);
  CarryAway(settings.carry, motion.begin, &poses);
  motion.spline = PoseSpline::Fit(poses, settings.knot_ms * 1e-3);
  motion.begin = std::max(motion.begin, motion.spline.begin());
  motion.end = std::min(motion.end, motion.spline.end());
  MeasureFit(poses, &motion);
  Shake(settings, &motion);
  return motion;
}

}  // namespace evit::simulation
