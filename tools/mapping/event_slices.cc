#include "tools/mapping/event_slices.h"

#include <algorithm>
#include <cmath>

namespace evit::mapping {
namespace {

constexpr Utime kStep = 1'000;  // us, in which motion is added up
constexpr int kInstants = 17;   // of the poses of a slice

// Pixels by which things `depth` m away move, from one camera pose to the next: mean over nine places.
double Motion(const Camera& camera, const SE3& from, const SE3& to, double depth) {
  const SE3 T = from.Inverse() * to;
  CameraSweep sweep;
  sweep.moved = T.p;
  sweep.turned = LogSO3(T.q);
  double sum = 0;
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const Eigen::Vector3d ray(0.35 * column * camera.width / camera.fx,
                                0.35 * row * camera.height / camera.fy, 1);
      sum += sweep.Flow(camera, depth * ray).norm();
    }
  }
  return sum / 9;
}

}  // namespace

std::vector<EventSlice> PlanSlices(const Trajectory& body, const Rig& rig, double depth,
                                   const EventSliceOptions& options) {
  std::vector<EventSlice> slices;
  if (body.empty()) return slices;
  const auto camera_at = [&](Utime t, SE3* pose) {
    SE3 T_map_body;
    if (!PoseAt(body, t, &T_map_body)) return false;
    *pose = T_map_body * rig.T_body_camera;
    return true;
  };
  bool started = false;
  Utime begin = 0;
  double moved = 0;
  SE3 last;
  for (Utime t = body.front().t; t <= body.back().t; t += kStep) {
    SE3 pose;
    const bool known = camera_at(t, &pose);
    if (!known || !started) {
      started = known, begin = t, moved = 0, last = pose;
      continue;
    }
    moved += Motion(rig.camera, last, pose, depth);
    last = pose;
    if (moved < options.moved_px && t - begin < options.longest) continue;
    if (moved >= options.least_px) {
      EventSlice slice;
      slice.begin = begin - rig.camera_time_offset;
      slice.end = t - rig.camera_time_offset;
      for (int k = 0; k < kInstants; ++k) {
        SE3 at;
        if (camera_at(begin + (t - begin) * k / (kInstants - 1), &at)) slice.T_map_camera.push_back(at);
      }
      if (slice.T_map_camera.size() == kInstants) slices.push_back(std::move(slice));
    }
    begin = t, moved = 0;
  }
  const std::size_t stride = std::max<std::size_t>(1, (slices.size() + options.most - 1) / options.most);
  std::vector<EventSlice> taken;
  for (std::size_t k = 0; k < slices.size(); k += stride) taken.push_back(std::move(slices[k]));
  return taken;
}

}  // namespace evit::mapping
