#include "common/photometric/photometric_lanes.h"

#include <gtest/gtest.h>

#include <random>

namespace evit {
namespace {

// The loops over lanes read the event image as EventImage::At does: in the middle, at the border where
// neighbours end, outside, and behind the camera, at any place of a block of lanes.
TEST(PhotometricLanes, ReadTheEventImageAsItsPlainReferenceDoes) {
  std::mt19937 random(5);
  cv::Mat counts(120, 160, CV_8UC1);
  for (int k = 0; k < 120 * 160; ++k) counts.data[k] = static_cast<unsigned char>(120 + random() % 17);
  const EventImage image(counts, 0.33, 1, 2);
  std::uniform_real_distribution<double> x(-5, 165), y(-5, 125);
  for (const Camera::Model model : {Camera::Model::kPlumbBob, Camera::Model::kEquidistant}) {
    Camera camera;
    camera.model = model;
    camera.width = 160, camera.height = 120;
    camera.fx = camera.fy = 200, camera.cx = 79.5, camera.cy = 59.5;
    AlignmentSettings settings;
    settings.set_camera(camera);
    int inside = 0;
    for (int n = 0; n < 2000; ++n) {
      const int level = n % 2;
      const Eigen::Vector3d along((x(random) - camera.cx) / camera.fx, (y(random) - camera.cy) / camera.fy,
                                  1);
      const bool behind = n % 10 == 9;
      const Eigen::Vector3d point = behind ? Eigen::Vector3d(-2 * along) : Eigen::Vector3d(2 * along);
      const std::vector<Eigen::Vector3f> points(static_cast<std::size_t>(1 + n % 3), point.cast<float>());
      PhotometricPoints scene{AlignmentPoints(points), {}};
      for (std::vector<float>& change : scene.change) change.assign(points.size() + kLanes, 0.5F);
      const EventSums sums = SumEvents(PhotometricBatch(settings, scene, SE3(), image, level), scene);

      Eigen::Vector2d pixel(-100, -100);
      const bool projects = camera.Project(point, &pixel);
      const double value = projects ? static_cast<double>(image.At(level, pixel.x(), pixel.y()).value) : 0;
      const auto count = static_cast<double>(points.size());
      ASSERT_NEAR(sums.squared, count * value * value, 2e-4) << pixel.transpose() << " level " << level;
      ASSERT_NEAR(sums.by_change[0], 0.5 * count * value, 2e-4) << pixel.transpose() << " level " << level;
      inside += value != 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 1000);
    EXPECT_LT(inside, 1900);
  }
}

}  // namespace
}  // namespace evit
