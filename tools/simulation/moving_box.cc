#include "tools/simulation/moving_box.h"

#include <algorithm>
#include <cmath>

#include "tools/simulation/scene_builder.h"

namespace evit::simulation {
namespace {

constexpr double kSweep = 0.55;     // m to either side
constexpr double kBob = 0.06;       // m up and down
constexpr double kTurn = 0.35;      // rad to either side
constexpr double kNearest = 1.0;    // m from the camera's mean place, at least
constexpr double kClearance = 0.7;  // m between the foremost place of the camera and the box's middle

}  // namespace

MovingBox::MovingBox(std::uint64_t seed, const PoseSpline& motion, const Rig& rig, Utime begin, Utime end)
    : begin_(begin) {
  constexpr Utime kStep = 20'000;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), look = mean;
  std::vector<Eigen::Vector3d> places;
  for (Utime t = begin; t <= end; t += kStep) {
    const SE3 T_map_camera = motion.Pose(t) * rig.T_body_camera;
    places.push_back(T_map_camera.p);
    mean += T_map_camera.p;
    look += T_map_camera.q * Eigen::Vector3d::UnitZ();
  }
  mean /= static_cast<double>(places.size());
  look.normalize();
  double foremost = 0;
  for (const Eigen::Vector3d& p : places) foremost = std::max(foremost, (p - mean).dot(look));
  centre_ = mean + std::max(kNearest, foremost + kClearance) * look;
  side_ = Eigen::Vector3d::UnitZ().cross(look).normalized();

  SceneBuilder builder(seed, 0xB0C5);
  Random& random = builder.random();
  for (int axis = 0; axis < 3; ++axis) size_[axis] = random.Uniform(0.4, 0.6);
  const double speed = random.Uniform(0.32, 0.42);  // m/s, mean; at most half as much again
  omega_ = 6.283185307179586 * speed / (4 * kSweep);
  phase_ = random.Uniform(0, 6.283185307179586);
  bob_phase_ = random.Uniform(0, 6.283185307179586);
  yaw_ = random.Uniform(0, 1.5);
  const Paint paint = builder.BusyPaint();
  builder.Box({0, 0, 1}, size_, 0, paint, builder.Grey(60, 200));
  box_ = builder.Take();
  for (Surface& face : box_.surfaces) face.origin.z() -= 1 + 0.5 * size_.z();
}

SE3 MovingBox::Pose(Utime t) const {
  const double s = omega_ * ToSeconds(t - begin_);
  const double yaw = yaw_ + kTurn * std::sin(0.8 * s + bob_phase_);
  return {ExpSO3(Eigen::Vector3d(0, 0, yaw)),
          centre_ + kSweep * std::sin(s + phase_) * side_ +
              Eigen::Vector3d(0, 0, kBob * std::sin(1.3 * s + bob_phase_))};
}

std::vector<Surface> MovingBox::At(Utime t) const {
  const SE3 T_map_box = Pose(t);
  std::vector<Surface> faces = box_.surfaces;
  for (Surface& face : faces) {
    face.origin = T_map_box * face.origin;
    face.edge_s = T_map_box.q * face.edge_s;
    face.edge_t = T_map_box.q * face.edge_t;
    face.normal = T_map_box.q * face.normal;
    face.gain = LightOn(face.normal);
  }
  return faces;
}

}  // namespace evit::simulation
