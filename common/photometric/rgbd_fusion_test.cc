#include "common/photometric/rgbd_fusion.h"

#include <gtest/gtest.h>

#include "tests/helpers/photometric_room.h"

namespace evit {
namespace {

RgbdView ViewOf(const test::Room& room, const SE3& T_map_body) {
  RgbdView view;
  view.camera = test::EventCamera();
  view.camera.distortion = {};
  view.T_map_camera = T_map_body * test::BodyCamera();
  const PhotometricView seen = room.See(view.camera, view.T_map_camera);
  for (std::size_t k = 0; k < seen.log_intensity.size(); ++k) {
    const float inverse = seen.inverse_depth[k];
    view.depth.push_back(inverse > 0 ? 1 / inverse : 0);
    view.intensity.push_back(inverse > 0 ? std::exp(seen.log_intensity[k]) - 0.012F : 0);
  }
  return view;
}

TEST(RgbdFusion, PointsLieOnTheWallsAndHaveTheirBrightness) {
  test::Room room;
  room.T_map_room = {ExpSO3({0.2, -0.1, 2}), {5, -3, 1}};
  RgbdFusion::Settings settings;
  settings.voxel = 0.008;  // a voxel at an edge has its point between two walls, the larger the farther off
  RgbdFusion fusion(settings);
  fusion.Add(ViewOf(room, room.T_map_room));
  fusion.Add(ViewOf(
      room, room.T_map_room.Plus((Eigen::Matrix<double, 6, 1>() << 0.1, 0.2, 0, 0, 0.1, 0.2).finished())));
  const PhotometricMap map = fusion.Finish();
  ASSERT_GT(map.points.size(), 50'000u);
  ASSERT_EQ(map.points.size(), map.intensities.size());
  double worst = 0, squares = 0;
  const SE3 T = room.T_map_room.Inverse();
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    const Eigen::Vector3d p = T * map.points[k].cast<double>();
    worst = std::max(worst, std::min(std::abs(p.x() - 3), std::abs(p.y() + 1.2)));
    squares += std::pow(map.intensities[k] - room.Intensity(p), 2);
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(map.points.size())), 0.01);
}

TEST(RgbdFusion, TheNearerViewCountsMore) {
  RgbdFusion::Settings settings;
  settings.voxel = 0.5;
  RgbdView view;
  view.camera.width = view.camera.height = 3;
  view.camera.fx = view.camera.fy = 100;
  view.camera.cx = view.camera.cy = 1;
  view.depth.assign(9, 1);
  view.intensity.assign(9, 0.2F);
  RgbdFusion fusion(settings);
  fusion.Add(view);
  view.T_map_camera.p.z() = -1;  // the same place from 2 m
  view.depth.assign(9, 2);
  view.intensity.assign(9, 1.0F);
  fusion.Add(view);
  const PhotometricMap map = fusion.Finish();
  ASSERT_EQ(map.points.size(), 1u);
  EXPECT_NEAR(map.intensities[0], (0.2 * 1 + 1.0 * 0.25) / 1.25, 1e-6);
  EXPECT_NEAR((map.points[0] - Eigen::Vector3f(0, 0, 1)).norm(), 0, 1e-6);
}

TEST(RgbdFusion, PixelsBesideAJumpOfDepthAreLeftOutSlantedWallsAreNot) {
  RgbdView view;
  view.camera.width = 40, view.camera.height = 10;
  view.camera.fx = view.camera.fy = 50, view.camera.cx = 20, view.camera.cy = 5;
  for (int k = 0; k < 400; ++k) {
    const int x = k % 40;
    view.depth.push_back(x < 20 ? 1.0F / (0.4F + 0.02F * static_cast<float>(x)) : 3.0F);
    view.intensity.push_back(0.5F);
  }
  RgbdFusion::Settings settings;
  settings.voxel = 1e-3;
  RgbdFusion fusion(settings);
  fusion.Add(view);
  EXPECT_EQ(fusion.size(), 36u * 8u);  // of 38 x 8 inner pixels, two columns at the jump
  view.depth.pop_back();
  EXPECT_THROW(fusion.Add(view), std::invalid_argument);
}

TEST(RgbdFusion, TheSameViewsGiveTheSameBits) {
  const test::Room room;
  PhotometricMap maps[2];
  for (PhotometricMap& map : maps) {
    RgbdFusion fusion({});
    fusion.Add(ViewOf(room, {}));
    map = fusion.Finish();
  }
  EXPECT_EQ(maps[0].points, maps[1].points);
  EXPECT_EQ(maps[0].intensities, maps[1].intensities);
}

}  // namespace
}  // namespace evit
