#include "tools/simulation/rgbd_views.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "common/parallel/parallel_for.h"
#include "tools/simulation/random.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {
namespace {

void WriteImage(const std::string& path, const cv::Mat& image) {
  if (!cv::imwrite(path, image)) throw std::runtime_error("cannot write " + path);
}

// Rows of a matrix, one line each, or all on one line.
template <typename Matrix>
void WriteNumbers(std::ostream* out, const Matrix& m, bool one_line) {
  for (int row = 0; row < m.rows(); ++row) {
    for (int column = 0; column < m.cols(); ++column) {
      const bool last_of_line = column + 1 == m.cols() && (!one_line || row + 1 == m.rows());
      *out << m(row, column) << (last_of_line ? '\n' : ' ');
    }
  }
}

cv::Mat DepthImage(const View& view, const Camera& camera, double noise, Random random) {
  cv::Mat depth(camera.height, camera.width, CV_16U);
  for (std::size_t i = 0; i < view.inverse_depth.size(); ++i) {
    const double metres = view.inverse_depth[i] > 0 ? 1.0 / view.inverse_depth[i] : 0;
    const double measured = noise > 0 ? metres * (1 + noise * random.Gaussian()) : metres;
    depth.ptr<std::uint16_t>()[i] =
        static_cast<std::uint16_t>(std::clamp(std::lround(1e3 * measured), 0L, 65535L));
  }
  return depth;
}

}  // namespace

Camera Rectified(const Camera& camera) {
  Camera rectified = camera;
  rectified.model = Camera::Model::kPlumbBob;
  rectified.distortion = {};
  return rectified;
}

void WriteRgbdViews(const std::string& folder, const Scene& scene, const Rig& rig, const PoseSpline& motion,
                    const std::vector<Utime>& times, const MapSettings& settings, std::uint64_t seed,
                    int threads) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (const char* part : {"images", "depth"}) {
    fs::create_directories(fs::path(folder) / part, error);
    if (error) throw std::runtime_error("cannot make " + folder + "/" + part + ": " + error.message());
  }
  const Camera camera = Rectified(rig.camera);
  const Renderer renderer(camera, scene);
  ParallelFor(static_cast<int>(times.size()), threads, [&](int i) {
    View view;
    renderer.Render(motion.Pose(times[i]) * rig.T_body_camera, &view);
    cv::Mat grey;
    cv::Mat(camera.height, camera.width, CV_32F, view.image.data()).convertTo(grey, CV_8U);
    char name[40];
    std::snprintf(name, sizeof(name), "/%05d.png", i);
    WriteImage(folder + "/images" + name, grey);
    WriteImage(folder + "/depth" + name,
               DepthImage(view, camera, settings.depth_noise,
                          Random(seed, 0xDE970000 + static_cast<std::uint64_t>(i))));
  });

  std::ofstream poses(folder + "/poses.txt"), intrinsics(folder + "/K.txt");
  poses << std::scientific << std::setprecision(18);
  intrinsics << std::scientific << std::setprecision(18);
  for (std::size_t i = 0; i < times.size(); ++i) {
    SE3 pose = motion.Pose(times[i]) * rig.T_body_camera;
    pose.p += ViewMisplacement(settings, seed, static_cast<int>(i));
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = pose.R();
    m.topRightCorner<3, 1>() = pose.p;
    WriteNumbers(&poses, m, true);
  }
  Eigen::Matrix3d k;
  k << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  WriteNumbers(&intrinsics, k, false);
  poses.close();
  intrinsics.close();
  if (!poses || !intrinsics) throw std::runtime_error("cannot write " + folder + "/poses.txt and K.txt");
}

}  // namespace evit::simulation
