#include "tools/simulation/camera_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <vector>

#include "common/config/rig_file.h"
#include "common/parallel/parallel_for.h"
#include "tools/simulation/grey_image.h"
#include "tools/simulation/image_map.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {
namespace {

constexpr double kStepPx = 1.5;  // of image motion, between two renders of one exposure
constexpr int kMostRenders = 16;

// Pixels per second at which the middle of the image moves by turning alone: translation adds little to it.
double TurnSpeed(const PoseSpline::Sample& sample, const Camera& camera) {
  return sample.rate.norm() * camera.fx;
}

std::vector<float> Expose(const Renderer& renderer, const PoseSpline& motion, const SE3& T_body_camera,
                          Utime t, double exposure_ms) {
  const double speed = TurnSpeed(motion.Evaluate(t), renderer.camera());
  const int n =
      std::clamp(static_cast<int>(std::ceil(1e-3 * exposure_ms * speed / kStepPx)), 1, kMostRenders);
  std::vector<float> light;
  View view;
  for (int k = 0; k < n; ++k) {
    const double off = ((k + 0.5) / n - 0.5) * 1e3 * exposure_ms;
    const Utime at = std::clamp<Utime>(t + std::llround(off), motion.begin(), motion.end());
    renderer.Render(motion.Pose(at) * T_body_camera, &view);
    if (light.empty()) light.assign(view.image.size(), 0);
    for (std::size_t i = 0; i < light.size(); ++i) light[i] += view.image[i] / static_cast<float>(n);
  }
  return light;
}

}  // namespace

void WriteCameraFrames(const std::string& folder, const Scene& scene, const Rig& rig,
                       const PoseSpline& motion, Utime begin, Utime end, const FrameSettings& settings,
                       std::uint64_t seed, int threads, const std::function<void(double)>& progress) {
  std::error_code error;
  const std::string pictures = folder + "/camera";
  std::filesystem::create_directories(pictures, error);
  if (error) throw std::runtime_error("cannot make " + pictures + ": " + error.message());
  const Renderer renderer(ScaledCamera(rig.camera, settings.scale), scene);
  Trajectory poses;
  for (int k = 0;; ++k) {
    const Utime t = begin + std::llround(1e6 * k / settings.rate_hz);
    if (t > end) break;
    poses.push_back({t, motion.Pose(t) * rig.T_body_camera});
  }
  std::mutex mutex;  // of progress
  std::size_t done = 0;
  ParallelFor(static_cast<int>(poses.size()), threads, [&](int k) {
    Random random(seed, 0xF2A3E000 + static_cast<std::uint64_t>(k));
    const Utime t = poses[k].t;
    cv::Mat picture;
    GreyImage(Expose(renderer, motion, rig.T_body_camera, t, settings.exposure_ms), renderer.camera(),
              settings.gamma, settings.grey_noise, &random)
        .convertTo(picture, CV_8U);
    char name[60];
    std::snprintf(name, sizeof name, "/%lld.%06lld.png", static_cast<long long>(t / kMicrosPerSecond),
                  static_cast<long long>(t % kMicrosPerSecond));
    if (!cv::imwrite(pictures + name, picture)) throw std::runtime_error("cannot write " + pictures + name);
    const std::lock_guard<std::mutex> lock(mutex);
    progress(static_cast<double>(++done) / static_cast<double>(poses.size()));
  });
  WriteTum(folder + "/camera_poses.tum", poses);
  MountedCamera camera;
  camera.camera = renderer.camera();
  camera.T_body_camera = rig.T_body_camera;
  camera.T_marker_body = rig.T_marker_body;
  WriteMountedCamera(folder + "/camera.textproto", camera, "The regular camera that was simulated.");
}

}  // namespace evit::simulation
