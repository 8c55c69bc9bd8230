#include "common/mapping/rectifier.h"

#include <gtest/gtest.h>

#include "tests/helpers/painted_scene.h"

namespace evit {
namespace {

Camera Distorted() {
  Camera camera;
  camera.width = 160, camera.height = 120;
  camera.fx = camera.fy = 120;
  camera.cx = 79.3, camera.cy = 60.4;
  camera.distortion = {-0.3, 0.1, 0.0003, -0.0002, 0};
  return camera;
}

TEST(Rectifier, LeavesAnImageWithoutDistortionAsItIs) {
  Camera camera = Distorted();
  camera.distortion = {};
  const Rectifier rectifier(camera);
  EXPECT_EQ(rectifier.camera().width, camera.width);
  EXPECT_EQ(rectifier.camera().height, camera.height);
  const cv::Mat image = PaintedScene::Wall().Picture(camera, PaintedScene::Poses(1, 0)[0]);
  EXPECT_EQ(cv::countNonZero(rectifier.Rectify(image) != image), 0);
}

TEST(Rectifier, ShowsWhatAPinholeCameraWouldSee) {
  const Camera camera = Distorted();
  const Rectifier rectifier(camera);
  EXPECT_GT(rectifier.camera().width, camera.width);
  const PaintedScene scene = PaintedScene::Wall();
  const SE3 pose = PaintedScene::Poses(1, 0)[0];
  cv::Mat off;
  cv::absdiff(rectifier.Rectify(scene.Picture(camera, pose)), scene.Picture(rectifier.camera(), pose), off);
  off.setTo(0, rectifier.valid() == 0);
  // Edges are a little softer; everything lies where it should.
  EXPECT_LT(cv::mean(off, rectifier.valid())[0], 2.0);
}

}  // namespace
}  // namespace evit
