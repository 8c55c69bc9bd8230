#pragma once

#include "common/geometry/rig.h"
#include "common/photometric/photometric_frame.h"
#include "common/photometric/photometric_options.h"
#include "common/photometric/photometric_term.h"
#include "common/photometric/photometric_view.h"

namespace evit {

/// Pose and motion of one frame.
struct PhotometricSolution {
  SE3 pose;  // T_map_body when its events were caused
  Twist twist = Twist::Zero();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // m, map frame: of the twist
  Matrix6d information = Matrix6d::Identity();       // on the pose
  PhotometricQuality quality;
  int iterations = 0;
  double image_speed = 0;  // pixels/s
};

/// Finds pose and motion of a frame from its events and a view of the photometric map, coarse to fine.
class PhotometricSolver {
 public:
  PhotometricSolver(const Rig& rig, const PhotometricOptions& options);

  /// `expected`: pose when the events were caused. `motion`: velocity (m/s) and angular rate (rad/s) of the
  /// body, map frame. Where the view shows too little: what was expected, with quality 0.
  PhotometricSolution Solve(const PhotometricFrame& frame, const PhotometricView& view, const SE3& expected,
                            const Twist& motion) const;

 private:
  std::vector<GradientPoint> PointsInImage(const PhotometricView& view, int level, const SE3& expected) const;
  void MinimizeAt(const PhotometricScene& scene, const SE3& expected, const Twist& prior,
                  PhotometricSolution* solution) const;

  SE3 T_camera_body_;
  Camera camera_;
  PhotometricOptions options_;
};

}  // namespace evit
