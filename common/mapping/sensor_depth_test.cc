#include "common/mapping/sensor_depth.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

// One edge at (20, 15), across x.
PosedEdges OneEdge() {
  EdgePixel edge;
  edge.pixel = {20, 15};
  Camera camera;
  camera.width = 40, camera.height = 30;
  return {{}, camera, EdgeImage(camera.width, camera.height, {edge}, true)};
}

// m, of the edge in a depth image with these depths left and right of it; 0: none.
double DepthOfEdge(const cv::Mat& depth) {
  const std::vector<EdgeDepth> depths = DepthsFromImage(OneEdge(), depth, {});
  return depths.empty() ? 0 : 1 / depths.front().inverse_depth;
}

cv::Mat Sides(float left, float right) {
  cv::Mat depth(30, 40, CV_32F, cv::Scalar(left));
  depth.colRange(20, 40) = right;
  return depth;
}

TEST(DepthsFromImage, AnEdgeOfSomethingIsAsNearAsItsNearSide) {
  EXPECT_NEAR(DepthOfEdge(Sides(1, 3)), 1, 1e-6);
  EXPECT_NEAR(DepthOfEdge(Sides(3, 1)), 1, 1e-6);
}

TEST(DepthsFromImage, AnEdgeOnASurfaceLiesOnIt) {
  cv::Mat slope(30, 40, CV_32F);
  for (int column = 0; column < 40; ++column) slope.col(column) = 2 + 0.01 * (column - 20);
  EXPECT_NEAR(DepthOfEdge(slope), 2, 1e-6);
}

TEST(DepthsFromImage, OneSideIsEnough) {
  EXPECT_NEAR(DepthOfEdge(Sides(0, 2)), 2, 1e-6);
  EXPECT_EQ(DepthOfEdge(Sides(0, 0)), 0);
  EXPECT_EQ(DepthOfEdge(Sides(0.1F, 9)), 0);  // out of the sensor's range
}

// Registered depth has lines of holes; the surface slopes, so that what is read farther off is extended back.
TEST(DepthsFromImage, AHoleOfOnePixelIsReadBeyond) {
  cv::Mat slope(30, 40, CV_32F);
  for (int column = 0; column < 40; ++column) slope.col(column) = 2 + 0.01 * (column - 20);
  slope.col(18) = 0, slope.col(22) = 0;
  EXPECT_NEAR(DepthOfEdge(slope), 2, 1e-6);
  slope.colRange(0, 20) = 0;
  EXPECT_NEAR(DepthOfEdge(slope), 2, 1e-6);
}

}  // namespace
}  // namespace evit
