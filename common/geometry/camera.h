#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace evit {

/// Pinhole camera with lens distortion, as ROS and Kalibr describe it. Camera frame: x right, y down, z
/// forward. Pixel (0, 0) is the centre of the top left pixel. A plain value: copy it, compare it, send it.
struct Camera {
  enum class Model { kPlumbBob, kEquidistant };

  Model model = Model::kPlumbBob;
  int width = 0, height = 0;              // pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;  // pixels
  std::array<double, 5> distortion{};     // plumb_bob: k1 k2 p1 p2 k3; equidistant: k1 k2 k3 k4, unused

  /// Projects a point of the camera frame (m) to a distorted pixel. False where the point is not in front of
  /// the camera or lies outside the radius up to which the distortion polynomial is monotonic. `jacobian`:
  /// d(pixel)/d(point), where not null.
  bool Project(const Eigen::Vector3d& point, Eigen::Vector2d* pixel,
               Eigen::Matrix<double, 2, 3>* jacobian = nullptr) const;

  /// The ray (z == 1) of a distorted pixel: inverse of Project by Newton's method. False where it does not
  /// converge.
  bool Unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d* ray) const;

  /// Whether a pixel lies in the image, at least `border` pixels inside (negative: outside allowed).
  bool Contains(const Eigen::Vector2d& pixel, double border = 0) const {
    return pixel.x() >= border && pixel.y() >= border && pixel.x() <= width - 1 - border &&
           pixel.y() <= height - 1 - border;
  }
};

/// "plumb_bob" / "equidistant" and back; false where the name is unknown ("radtan" is an alias of plumb_bob).
bool CameraModelFromName(const std::string& name, Camera::Model* model);
const char* CameraModelName(Camera::Model model);

}  // namespace evit
