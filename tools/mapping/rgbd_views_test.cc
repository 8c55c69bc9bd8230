#include "tools/mapping/rgbd_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/mapping/edge_detector.h"
#include "common/mapping/map_builder.h"
#include "tests/helpers/paths.h"
#include "tools/formats/rgbd/rgbd_folder.h"

namespace evit::mapping {
namespace {

constexpr int kFiner = 4;  // distances are measured in a finer grid than the picture's, in quarter pixels

// The cell of a pixel (0, 0: the middle of the first) in the finer grid.
cv::Point CellOf(const Eigen::Vector2d& pixel) {
  return {static_cast<int>(kFiner * (pixel.x() + 0.5)), static_cast<int>(kFiner * (pixel.y() + 0.5))};
}

// Pixels, from each place of a finer picture to the nearest point of the map in it.
cv::Mat DistanceToMap(const std::vector<MappedPoint>& points, const PinholeView& view) {
  cv::Mat empty(kFiner * view.camera.height, kFiner * view.camera.width, CV_8U, cv::Scalar(1));
  for (const MappedPoint& point : points) {
    const Eigen::Vector3d p = view.InCamera(point.position);
    if (p.z() < 0.2 || !view.camera.Contains(view.Pixel(p))) continue;
    empty.at<std::uint8_t>(CellOf(view.Pixel(p))) = 0;
  }
  cv::Mat distance;
  cv::distanceTransform(empty, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance / kFiner;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A map from every second of 60 frames of a HoloLens, 20 cm and 10 degrees apart: the edges of the others,
// found as the map's own are, lie on it.
TEST(ReadRgbdOfARealSensor, MapShowsTheEdgesOfViewsLeftOut) {
  const std::string path = test::RecordingsPath("hololens");
  if (!std::filesystem::exists(path + "/poses.txt"))
    GTEST_SKIP() << "no " << path << "; set EVIT_SHARED_DATA";
  FrameReaderOptions reader;
  reader.max_frames = 30;
  reader.edges.sure_contrast = 0.25, reader.edges.min_contrast = 0.125;
  RgbdEdges edges = ReadRgbd(path, 0, 60, reader, 10, [](double) {});
  ASSERT_EQ(edges.frames.views.size(), 30U);
  const BuiltMap map = BuildMapFromDepths(std::move(edges.frames.views), std::move(edges.depths), {},
                                          [](double, const std::string&) {});

  const formats::RgbdFolder folder(path);
  std::vector<double> medians;
  for (std::size_t k = 1; k < 60; k += 2) {
    RgbdView view = folder.Load(k);
    const Camera& camera = view.camera;
    cv::Mat grey;
    cv::Mat(camera.height, camera.width, CV_32F, view.intensity.data()).convertTo(grey, CV_8U, 255);
    const cv::Mat distance = DistanceToMap(map.points, {view.T_map_camera, camera});
    std::vector<double> of_edges;
    for (const EdgePixel& edge : DetectEdges(grey, cv::Mat(), reader.edges))
      of_edges.push_back(distance.at<float>(CellOf(edge.pixel.cast<double>())));
    medians.push_back(Median(of_edges));
  }
  std::printf("edges of 30 views left out: %.2f px (median) from the map\n", Median(medians));
  EXPECT_LT(Median(medians), 1.5);
}

}  // namespace
}  // namespace evit::mapping
