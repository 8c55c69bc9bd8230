#include "common/tracking/state.h"

namespace evit {

StateBlocks ToBlocks(const BodyState& s) {
  StateBlocks b;
  Eigen::Map<Eigen::Vector3d>(b.pose.data()) = s.T_map_body.p;
  Eigen::Map<Eigen::Vector4d>(b.pose.data() + 3) = s.T_map_body.q.coeffs();
  Eigen::Map<Eigen::Vector3d>(b.motion.data()) = s.velocity;
  Eigen::Map<Eigen::Vector3d>(b.motion.data() + 3) = s.bias.gyro;
  Eigen::Map<Eigen::Vector3d>(b.motion.data() + 6) = s.bias.accel;
  return b;
}

SE3 PoseFromBlock(const double* pose) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(pose + 3)),
          Eigen::Map<const Eigen::Vector3d>(pose)};
}

BodyState FromBlocks(const StateBlocks& b) {
  BodyState s;
  s.T_map_body = PoseFromBlock(b.pose.data());
  s.velocity = Eigen::Map<const Eigen::Vector3d>(b.motion.data());
  s.bias.gyro = Eigen::Map<const Eigen::Vector3d>(b.motion.data() + 3);
  s.bias.accel = Eigen::Map<const Eigen::Vector3d>(b.motion.data() + 6);
  return s;
}

SE3 PoseAfter(const BodyState& state, const Eigen::Vector3d& rate, double seconds) {
  const SE3& pose = state.T_map_body;
  return {(pose.q * ExpSO3(seconds * rate)).normalized(), pose.p + seconds * state.velocity};
}

Vector15d Minus(const BodyState& b, const BodyState& a) {
  Eigen::Matrix<double, 15, 1> d;
  d << b.T_map_body.p - a.T_map_body.p, LogSO3(a.T_map_body.q.conjugate() * b.T_map_body.q),
      b.velocity - a.velocity, b.bias.gyro - a.bias.gyro, b.bias.accel - a.bias.accel;
  return d;
}

BodyState Plus(const BodyState& state, const Vector15d& step) {
  BodyState moved;
  moved.T_map_body = state.T_map_body.Plus(step.head<6>());
  moved.velocity = state.velocity + step.segment<3>(6);
  moved.bias.gyro = state.bias.gyro + step.segment<3>(9);
  moved.bias.accel = state.bias.accel + step.segment<3>(12);
  return moved;
}

}  // namespace evit
