#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/calibration/camera_imu_calibration.h"
#include "common/overlap/map_event_overlap.h"

namespace evit {

struct OverlapCalibration {
  /// T_body_camera (position m in the body frame, rotation rad in the camera frame: a right perturbation) and
  /// offset (s).
  using Covariance = Eigen::Matrix<double, 7, 7>;

  bool success = false;
  std::string reason;  // for a person, where it failed
  SE3 T_body_camera;
  Utime offset = 0;  // us to add to the camera's stamps to get the IMU's
  Covariance covariance = Covariance::Zero();
  std::vector<Unobservable> unobservable;  // kept as the rig file has it
  MapEventOverlap before, after;           // with the rig file's figures, with these
};

struct OverlapCalibrationOptions {
  double search_deg = 3;          // about each axis: how wrong the rig file may be
  double position_sigma = 0.001;  // m: of the rig file's translation, per axis, where it says nothing of it
  double offset_sigma = 0.1;      // s
  double lag_px = 0.25, lag_sigma = 0.25;  // pixels: SurfaceOptions::lag_px, and how far sensors differ
  double blur_px = 2;                      // of the events, at last
  /// pixels: how far map, lens model and events may lie beside each other alike in all views. Goes into the
  /// sigmas of rotation and offset, which the spread between stretches does not show.
  double registration_px = 0.5;
  /// Called between steps, some hundred times; what it throws ends the calibration. Empty: nothing.
  std::function<void()> between_steps{};
};

/// Extrinsics and time offset of an event camera where the body's poses are known (motion capture): what
/// makes the map lie on the events, seen from all views at once. Neither IMU nor tracker are asked.
///
/// Events of a slice are symmetric in time around its view, so that they neither lead nor lag but for what a
/// pixel waits until it fires: a distance, which is solved for beside the offset, a time; only changing speed
/// tells them apart. A search over turns of the camera, on blurred events, then steps to the minimum
/// (OverlapCost). The covariance is the sandwich of curvature and the spread of the gradient between
/// stretches of the recording (Huber 1967; White 1982), which assumes nothing about how points or views err
/// together within one; what errs alike in all of it comes on top (registration_px). Half a pixel is 0.09 deg
/// for VECtor's camera and 5 ms at 100 pixels/s: the offset asks for fast motion.
///
/// A turn of the camera and a shift of it differ only by the depths in view, and a map's errors along the
/// view differ with depth too: the rig file's translation, which a drawing gives to a millimetre, counts with
/// its sigma.
///
/// `views`: from PlanViews() of these poses and `rig`, their events filled in. `body`: T_map_body, IMU clock.
OverlapCalibration CalibrateByOverlap(const std::vector<MapView>& views, const Trajectory& body,
                                      const Rig& rig, const OverlapCalibrationOptions& options = {});

}  // namespace evit
