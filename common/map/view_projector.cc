#include "common/map/view_projector.h"

#include <algorithm>

namespace evit {
namespace {

template <Camera::Model kModel>
EVIT_ALWAYS_INLINE std::size_t Block(const ViewProjector::View& view, const float* x, const float* y,
                                     const float* z, const std::int32_t* ids, int n, ProjectedPoint* out) {
  alignas(64) float u[kLanes], v[kLanes], depth[kLanes];
  alignas(64) std::int32_t in_view[kLanes];
  const float* const R = view.R;
  for (int l = 0; l < kLanes; ++l) {
    const float px = R[0] * x[l] + R[1] * y[l] + R[2] * z[l] + view.t[0];
    const float py = R[3] * x[l] + R[4] * y[l] + R[5] * z[l] + view.t[1];
    const float pz = R[6] * x[l] + R[7] * y[l] + R[8] * z[l] + view.t[2];
    const bool ahead = pz > 1e-6F;
    const float inverse = 1 / (ahead ? pz : 1);
    const float mx = px * inverse, my = py * inverse, r2 = mx * mx + my * my;
    const LaneDistortion d = DistortLane<kModel>(view.camera, mx, my);
    u[l] = view.camera.fx * d.x + view.camera.cx;
    v[l] = view.camera.fy * d.y + view.camera.cy;
    depth[l] = pz;
    in_view[l] = static_cast<int>(ahead) & static_cast<int>(pz >= view.near) &
                 static_cast<int>(pz <= view.far) & static_cast<int>(r2 <= view.camera.max_radius2) &
                 static_cast<int>(u[l] >= view.left) & static_cast<int>(u[l] <= view.right) &
                 static_cast<int>(v[l] >= view.top) & static_cast<int>(v[l] <= view.bottom);
  }
  std::size_t kept = 0;
  for (int l = 0; l < n; ++l) {  // no branch: whether a point is in view is hard to predict
    out[kept] = {ids[l], {u[l], v[l]}, depth[l]};
    kept += static_cast<std::size_t>(in_view[l]);
  }
  return kept;
}

// `out` has room for n points and one more; x, y and z can be read for a block beyond n.
template <Camera::Model kModel>
EVIT_ALWAYS_INLINE std::size_t Blocks(const ViewProjector::View& view, const float* x, const float* y,
                                      const float* z, const std::int32_t* ids, std::size_t n,
                                      ProjectedPoint* out) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < n; k += kLanes) {
    const int lanes = n - k < kLanes ? static_cast<int>(n - k) : kLanes;
    kept += Block<kModel>(view, x + k, y + k, z + k, ids + k, lanes, out + kept);
  }
  return kept;
}

EVIT_MULTIVERSION std::size_t PlumbBobBlocks(const ViewProjector::View& view, const float* x, const float* y,
                                             const float* z, const std::int32_t* ids, std::size_t n,
                                             ProjectedPoint* out) {
  return Blocks<Camera::Model::kPlumbBob>(view, x, y, z, ids, n, out);
}

EVIT_MULTIVERSION std::size_t EquidistantBlocks(const ViewProjector::View& view, const float* x,
                                                const float* y, const float* z, const std::int32_t* ids,
                                                std::size_t n, ProjectedPoint* out) {
  return Blocks<Camera::Model::kEquidistant>(view, x, y, z, ids, n, out);
}

}  // namespace

ViewProjector::ViewProjector(const Camera& camera, const SE3& T_camera_map, double margin_px,
                             double min_depth, double max_depth)
    : view_{LaneCamera(camera),
            camera.model == Camera::Model::kEquidistant,
            {},
            {},
            static_cast<float>(-margin_px),
            static_cast<float>(camera.width - 1 + margin_px),
            static_cast<float>(-margin_px),
            static_cast<float>(camera.height - 1 + margin_px),
            static_cast<float>(min_depth),
            static_cast<float>(std::min(max_depth, 1e30))} {
  const Eigen::Matrix3d R = T_camera_map.R();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) view_.R[3 * r + c] = static_cast<float>(R(r, c));
    view_.t[r] = static_cast<float>(T_camera_map.p[r]);
  }
}

std::size_t ViewProjector::Project(const PointArrays& points, const std::int32_t* ids, std::size_t begin,
                                   std::size_t end, ProjectedPoint* seen) const {
  const auto run = view_.fisheye ? EquidistantBlocks : PlumbBobBlocks;
  return run(view_, points.x() + begin, points.y() + begin, points.z() + begin, ids + begin, end - begin,
             seen);
}

}  // namespace evit
