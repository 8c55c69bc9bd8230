#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "evit/camera_t.hpp"

/// Poses, vectors and cameras as fields of messages. Incoming messages must have been checked
/// (DecodeChecked).
namespace evit {

inline void Put(const Eigen::Vector3d& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }

/// To fields `position` (m) and `orientation` (x y z w).
template <typename Message>
void PutPose(const SE3& pose, Message* m) {
  Put(pose.p, m->position);
  std::copy_n(pose.q.coeffs().data(), 4, m->orientation);
}

template <typename Message>
SE3 PoseOf(const Message& m) {
  const double* const q = m.orientation;
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(), Eigen::Vector3d(m.position)};
}

camera_t ToMessage(const Camera& camera);
Camera FromMessage(const camera_t& message);

}  // namespace evit
