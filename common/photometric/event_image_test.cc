#include "common/photometric/event_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "common/photometric/gradient_points.h"
#include "tests/helpers/photometric_room.h"

namespace evit {
namespace {

cv::Mat RandomCounts() {
  std::mt19937 random(5);
  cv::Mat counts(120, 160, CV_8UC1);
  for (int k = 0; k < 120 * 160; ++k) counts.data[k] = static_cast<unsigned char>(120 + random() % 17);
  return counts;
}

TEST(EventImage, SlopeIsThatOfTheValue) {
  const EventImage image(RandomCounts(), 0.33, 1, 2);
  std::mt19937 random(6);
  for (const int level : {0, 1}) {
    for (int n = 0; n < 300; ++n) {
      const double x = 20 + random() % 1200 * 0.1, y = 20 + random() % 800 * 0.1, h = 1e-2;
      const auto value = [&](double a, double b) { return static_cast<double>(image.At(level, a, b).value); };
      const EventImage::Sample s = image.At(level, x, y);
      EXPECT_NEAR(s.gx, (value(x + h, y) - value(x - h, y)) / (2 * h), 5e-4);
      EXPECT_NEAR(s.gy, (value(x, y + h) - value(x, y - h)) / (2 * h), 5e-4);
    }
  }
}

TEST(EventImage, APlaneOfChangeIsWhereItWas) {
  cv::Mat counts(120, 160, CV_8UC1);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x)
      counts.at<unsigned char>(y, x) = static_cast<unsigned char>(20 + x + y / 2 * 1);
  }
  const EventImage image(counts, 0.5, 1, 2);
  EXPECT_EQ(image.image(1).cols, 40);
  for (const int level : {0, 1}) {
    const EventImage::Sample s = image.At(level, 83.3, 61.2);
    EXPECT_NEAR(s.value, 0.5 * (20 + 83.3 + (61.2 - 0.5) / 2 - 128), 0.02);
    EXPECT_NEAR(s.gx, 0.5, 0.01);
    EXPECT_NEAR(s.gy, 0.25, 0.01);
    EXPECT_EQ(image.At(level, -1, 50).value, 0);  // nothing happens outside
    EXPECT_EQ(image.At(level, 50, 1000).gx, 0);
    EXPECT_EQ(image.At(level, std::nan(""), 50).value, 0);
  }
}

TEST(GradientPoints, LieOnTheWallsWithTheirGradient) {
  test::Room room;
  room.T_map_room = {ExpSO3({0.4, -0.2, 1.2}), {-7, 2, 4}};
  const SE3 T_camera = room.T_map_room * SE3(ExpSO3({0.6, 0.1, -0.2}), {0.2, 0.1, 0}) * test::BodyCamera();
  const PhotometricView view = room.See(ViewCamera(test::EventCamera(640, 480), 0.1), T_camera);
  for (const int level : {0, 1}) {
    const auto points = FindGradientPoints(view, level, 0, 0.05, 2000);
    ASSERT_GT(points.size(), 900u);
    EXPECT_LE(points.size(), 2000u);
    int good = 0;
    for (const GradientPoint& g : points) {
      const Eigen::Vector3d p = room.T_map_room.Inverse() * g.point;
      const bool on_wall = std::min(std::abs(p.x() - 3), std::abs(p.y() + 1.2)) < 0.03;
      // At right angles to the line of sight; and what a step along the gradient changes is what it says.
      const Eigen::Vector3d sight = (g.point - T_camera.p).normalized();
      EXPECT_LT(std::abs(sight.dot(g.gradient)), 1e-9 * (1 + g.gradient.norm()));
      const double depth = (T_camera.Inverse() * g.point).z();
      const double pixel = depth * (1 << level) / view.query.camera.fx;  // m
      const Eigen::Vector3d step = pixel * g.gradient.normalized();
      const auto light = [&](const Eigen::Vector3d& q) {  // at the wall behind q
        const SE3 T = room.T_map_room.Inverse();
        const Eigen::Vector3d eye = T * T_camera.p, ray = T * q - eye;
        return std::log(room.Intensity(eye + test::Room::Cast(eye, ray) * ray) + test::Room::kDark);
      };
      const double change = (light(g.point + step) - light(g.point - step)) / (2 * pixel);
      good += on_wall && std::abs(change - g.gradient.norm()) < 0.3 * g.gradient.norm() ? 1 : 0;
    }
    EXPECT_GT(good, 0.7 * static_cast<double>(points.size()));
  }
}

TEST(GradientPoints, WhereNothingIsSeenThereIsNoEdge) {
  PhotometricView view;
  view.query.camera = ViewCamera(test::EventCamera(), 0);
  view.log_intensity.assign(std::size_t{160} * 120, -1);
  view.inverse_depth.assign(std::size_t{160} * 120, 0.5F);
  for (int y = 0; y < 120; ++y) {
    for (int x = 60; x < 90; ++x) view.log_intensity[160 * y + x] = 0, view.inverse_depth[160 * y + x] = 0;
  }
  for (const int level : {0, 1}) EXPECT_TRUE(FindGradientPoints(view, level, 1, 0.01, 1000).empty());
}

}  // namespace
}  // namespace evit
