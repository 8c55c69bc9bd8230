#include "common/wire/geometry_wire.h"

#include <iterator>

namespace evit {

camera_t ToMessage(const Camera& camera) {
  camera_t m{};
  m.model = CameraModelName(camera.model);
  m.width = camera.width;
  m.height = camera.height;
  m.fx = camera.fx;
  m.fy = camera.fy;
  m.cx = camera.cx;
  m.cy = camera.cy;
  std::copy(camera.distortion.begin(), camera.distortion.end(), m.distortion);
  return m;
}

Camera FromMessage(const camera_t& m) {
  Camera camera;
  CameraModelFromName(m.model, &camera.model);
  camera.width = m.width;
  camera.height = m.height;
  camera.fx = m.fx;
  camera.fy = m.fy;
  camera.cx = m.cx;
  camera.cy = m.cy;
  std::copy(std::begin(m.distortion), std::end(m.distortion), camera.distortion.begin());
  return camera;
}

}  // namespace evit
