#include "common/mapping/stereo_neighbour.h"

namespace evit {

EdgeRay::EdgeRay(const PosedEdges& view, const EdgePixel& edge, double typical_depth)
    : ray((edge.pixel.x() - view.camera.cx) / view.camera.fx,
          (edge.pixel.y() - view.camera.cy) / view.camera.fy, 1),
      tangent(edge.normal.y() / view.camera.fx, -edge.normal.x() / view.camera.fy, 0),
      way(view.sweep.Way(view.camera, ray * typical_depth, edge.normal)) {}

StereoNeighbour::StereoNeighbour(const PosedEdges& key, const PosedEdges& view) : view_(&view) {
  const SE3 T = view.T_map_camera.Inverse() * key.T_map_camera;
  R_ = T.R();
  t_ = T.p;
}

void StereoNeighbour::Aim(const EdgeRay& edge, double typical_depth) {
  const Camera& camera = view_->camera;
  far_ = R_ * edge.ray;
  shows_ = far_.z() >= 0.1;
  if (!shows_) return;
  // The tangent turned as the cameras are to each other; the normal is on its left.
  const Eigen::Vector3d along = R_ * edge.tangent;
  const Eigen::Vector2d image(camera.fx * (along.x() - far_.x() / far_.z() * along.z()),
                              camera.fy * (along.y() - far_.y() / far_.z() * along.z()));
  normal_ = Eigen::Vector2f(static_cast<float>(-image.y()), static_cast<float>(image.x())).normalized();
  bin_ = EdgeImage::BinOf(normal_);
  const Eigen::Vector3d there = far_ * typical_depth + t_;
  shows_ = view_->sweep.Shows(camera, there, normal_);
  if (shows_) late_ = view_->sweep.Way(camera, there, normal_) - edge.way;
}

Eigen::Vector2d StereoNeighbour::Move(const Eigen::Vector3d& p) const {
  const Camera& camera = view_->camera;
  return {camera.fx * (t_.x() * p.z() - p.x() * t_.z()) / (p.z() * p.z()),
          camera.fy * (t_.y() * p.z() - p.y() * t_.z()) / (p.z() * p.z())};
}

}  // namespace evit
