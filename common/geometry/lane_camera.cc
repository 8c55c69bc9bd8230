#include "common/geometry/lane_camera.h"

#include <algorithm>

namespace evit {
namespace {

// Largest squared radius up to which Camera::Project accepts: by bisection, since that set is an interval.
float MaxRadius2(const Camera& camera) {
  const auto accepted = [&](double r) {
    Eigen::Vector2d pixel;
    return camera.Project({r, 0, 1}, &pixel);
  };
  double low = 0, high = camera.model == Camera::Model::kPlumbBob ? 5 : 1e6;
  if (accepted(high)) return static_cast<float>(high * high);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (accepted(middle) ? low : high) = middle;
  }
  return static_cast<float>(low * low);
}

}  // namespace

LaneCamera::LaneCamera(const Camera& camera)
    : fx(static_cast<float>(camera.fx)),
      fy(static_cast<float>(camera.fy)),
      cx(static_cast<float>(camera.cx)),
      cy(static_cast<float>(camera.cy)),
      max_radius2(MaxRadius2(camera)) {
  std::transform(camera.distortion.begin(), camera.distortion.end(), k,
                 [](double d) { return static_cast<float>(d); });
}

}  // namespace evit
