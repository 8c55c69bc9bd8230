#include "tools/simulation/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "tools/simulation/edge_map.h"
#include "tools/simulation/room.h"

namespace evit::simulation {
namespace {

Camera TestCamera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 160;
  camera.cx = 159.5;
  camera.cy = 119.5;
  camera.distortion = {-0.03, 0.04, -0.0005, -0.001, 0};
  return camera;
}

// Stands in the room, looks along +x, a little down, turned about the optical axis.
SE3 Pose(double yaw, double pitch, double roll) {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {
      Eigen::Quaterniond(R) * ExpSO3(Eigen::Vector3d(pitch, yaw, 0)) * ExpSO3(Eigen::Vector3d(0, 0, roll)),
      Eigen::Vector3d(-0.6, 0.1, 1.4)};
}

// The drawing with its screen spans and depth buffer agrees with testing every surface for every ray.
TEST(Renderer, DepthIsThatOfTheRays) {
  const Scene scene = MakeRoom(3);
  const Camera camera = TestCamera();
  const Renderer renderer(camera, scene);
  View view;
  for (int k = 0; k < 6; ++k) {
    const SE3 T_map_camera = Pose(k * 1.1, 0.3 * k - 0.7, 0.9 * k);
    renderer.Render(T_map_camera, &view);
    int different = 0, checked = 0;
    for (int y = 0; y < camera.height; y += 3) {
      for (int x = 0; x < camera.width; x += 3) {
        Eigen::Vector3d ray;
        ASSERT_TRUE(camera.Unproject({x, y}, &ray));
        const Hit hit = CastRay(scene, T_map_camera.p, T_map_camera.q * ray);
        ASSERT_GE(hit.surface, 0);
        ++checked;
        const std::size_t i = static_cast<std::size_t>(y) * camera.width + x;
        if (std::abs(1 / view.inverse_depth[i] - hit.depth) > 1e-3 * hit.depth) ++different;
      }
    }
    EXPECT_LT(different, checked / 2000) << k;  // rays that pass a border within rounding
  }
}

// A vertical border between dark and bright moves by a fraction of a pixel: so does the pixel's grey.
TEST(Renderer, BordersMoveSmoothly) {
  Scene scene;
  scene.textures.emplace_back(cv::Mat(2, 2, CV_32F, cv::Scalar(50)), 1.0F, true);
  scene.textures.emplace_back(cv::Mat(2, 2, CV_32F, cv::Scalar(200)), 1.0F, true);
  const auto add = [&](double x, double width, double z, const Texture* texture) {
    Surface s;
    s.origin = {x, -4, z};
    s.edge_s = {width, 0, 0};
    s.edge_t = {0, 8, 0};
    s.normal = {0, 0, -1};
    s.texture = texture;
    scene.surfaces.push_back(s);
  };
  add(-10, 20, 3, &scene.textures[0]);  // behind
  add(0, 10, 2, &scene.textures[1]);    // in front, right half
  Camera camera = TestCamera();
  camera.distortion = {};
  const Renderer renderer(camera, scene);
  View view;
  const int row = 120;
  for (int k = 0; k <= 32; ++k) {
    const double shift = k / 32.0;  // px
    SE3 T_map_camera;
    T_map_camera.p.x() = -(159.5 + shift - camera.cx) * 2 / camera.fx;  // border at column 159.5 + shift
    renderer.Render(T_map_camera, &view);
    const double grey = view.image[row * camera.width + 160];
    EXPECT_NEAR(grey, 200 - 150 * shift, 150 * 0.07) << k;
  }
}

TEST(MakeRoom, IsTheSameForASeedAndAnotherForAnother) {
  const Scene a = MakeRoom(1), b = MakeRoom(1), c = MakeRoom(2);
  View va, vb, vc;
  Renderer(TestCamera(), a).Render(Pose(0, 0.1, 0), &va);
  Renderer(TestCamera(), b).Render(Pose(0, 0.1, 0), &vb);
  Renderer(TestCamera(), c).Render(Pose(0, 0.1, 0), &vc);
  EXPECT_EQ(va.image, vb.image);
  int different = 0;
  for (std::size_t i = 0; i < va.image.size(); ++i) different += std::abs(va.image[i] - vc.image[i]) > 10;
  EXPECT_GT(different, static_cast<int>(va.image.size() / 4));
}

TEST(MakeRoom, LeavesItsFreeSpaceFree) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene scene = MakeRoom(seed);
    for (double x = -1.5; x <= 0.5; x += 0.25) {
      for (double y = -1.2; y <= 1.2; y += 0.3) {
        const Hit hit = CastRay(scene, {x, y, scene.free_space.max().z()}, {0, 0, -1});
        EXPECT_GE(hit.depth, scene.free_space.sizes().z()) << seed << " at " << x << " " << y;
      }
    }
  }
}

// Without its errors, every point of the map lies on a surface.
TEST(EdgeMap, PointsLieOnSurfaces) {
  const Scene scene = MakeRoom(4);
  Rig rig;
  rig.camera = TestCamera();
  const Renderer renderer(rig.camera, scene);
  Trajectory poses;
  for (int i = 0; i < 60; ++i) {
    SE3 pose = Pose(0.02 * i, 0.1, 0);
    pose.p.y() += 0.005 * i;
    poses.push_back({Utime{i} * 10'000, pose});
  }
  const PoseSpline motion = PoseSpline::Fit(poses, 0.05);
  MapSettings settings;
  settings.depth_noise = settings.edge_noise_px = settings.view_jitter_m = settings.outlier_share = 0;
  int views = 0;
  const PointMap map =
      MakeEdgeMap(renderer, rig, motion, motion.begin(), motion.end(), settings, 1, 2, &views);
  EXPECT_GE(views, 2);
  ASSERT_GT(map.points.size(), 2000U);
  std::size_t off = 0;
  for (const Eigen::Vector3f& p : map.points) {
    double nearest = 1;
    for (const Surface& s : scene.surfaces) {
      const Eigen::Vector3d local = p.cast<double>() - s.origin;
      if (s.kind == Surface::Kind::kSphere) {
        nearest = std::min(nearest, std::abs(local.norm() - s.radius));
      } else if (s.kind == Surface::Kind::kCylinder) {
        nearest = std::min(nearest, std::abs(local.head<2>().norm() - s.radius));
      } else {
        const double u = local.dot(s.edge_s) / s.edge_s.norm(), v = local.dot(s.edge_t) / s.edge_t.norm();
        const double out = std::max({-u, -v, u - s.edge_s.norm(), v - s.edge_t.norm(), 0.0});
        nearest = std::min(nearest, std::max(out, std::abs(local.dot(s.normal))));
      }
    }
    off += nearest > 0.02;  // an edge pixel beside a border, at 2 to 3 m with 160 px focal length
  }
  EXPECT_LT(static_cast<double>(off), 0.02 * static_cast<double>(map.points.size()));
}

}  // namespace
}  // namespace evit::simulation
