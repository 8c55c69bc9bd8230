#include "common/mapping/edge_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit {
namespace {

// A bright half plane right of the line through (32.3, 30) with this normal, anti-aliased.
cv::Mat HalfPlane(double angle, int dark, int bright) {
  cv::Mat image(60, 64, CV_8U);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const double off = (column - 32.3) * std::cos(angle) + (row - 30) * std::sin(angle);
      const double share = 0.5 * (1 + std::erf(off / (std::sqrt(2.0) * 0.6)));
      image.at<std::uint8_t>(row, column) =
          static_cast<std::uint8_t>(std::lround(dark + share * (bright - dark)));
    }
  }
  return image;
}

TEST(DetectEdges, FindsAStepToATenthOfAPixelWithItsDirectionAndContrast) {
  for (const double angle : {0.0, 0.4, 1.3, 3.0, -1.0}) {
    const auto edges = DetectEdges(HalfPlane(angle, 40, 160), cv::Mat(), {});
    ASSERT_GT(edges.size(), 40U) << angle;
    for (const EdgePixel& e : edges) {
      const double off = (e.pixel.x() - 32.3) * std::cos(angle) + (e.pixel.y() - 30) * std::sin(angle);
      EXPECT_NEAR(off, 0, 0.12) << angle;
      EXPECT_GT(e.normal.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>()), 0.99) << angle;
      EXPECT_LT(e.dark, e.bright);
      EXPECT_NEAR(e.bright, std::log(168.0), 0.1);
    }
  }
}

// The gradient of one pixel errs by several degrees in a noisy picture; the line does not. A corner's two
// sides keep theirs.
TEST(DetectEdges, TellsTheDirectionOfALineByItsNeighbours) {
  for (const double angle : {0.0, 0.4, 0.8, 1.3}) {
    cv::Mat image = HalfPlane(angle, 60, 120), noise(image.size(), CV_16S);
    cv::RNG(3).fill(noise, cv::RNG::NORMAL, 0, 6);
    cv::add(image, noise, image, cv::noArray(), CV_8U);
    const Eigen::Vector2f normal(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
    double square = 0;
    const auto edges = DetectEdges(image, cv::Mat(), {});
    ASSERT_GT(edges.size(), 30U) << angle;
    for (const EdgePixel& e : edges) square += (e.normal - normal).squaredNorm();
    EXPECT_LT(std::sqrt(square / static_cast<double>(edges.size())), 0.04) << angle;
  }
  cv::Mat corner(60, 64, CV_8U, cv::Scalar(40));
  corner(cv::Rect(0, 0, 30, 30)).setTo(160);
  for (const EdgePixel& e : DetectEdges(corner, cv::Mat(), {})) {
    if (e.pixel.y() < 24) {
      EXPECT_LT(e.normal.x(), -0.99F) << e.pixel.transpose();
    }
    if (e.pixel.x() < 24) {
      EXPECT_LT(e.normal.y(), -0.99F) << e.pixel.transpose();
    }
  }
}

TEST(DetectEdges, FindsNothingInAFlatOrBarelyChangingImage) {
  EXPECT_TRUE(DetectEdges(HalfPlane(0.3, 100, 108), cv::Mat(), {}).empty());
  EXPECT_TRUE(DetectEdges(cv::Mat(60, 64, CV_8U, cv::Scalar(0)), cv::Mat(), {}).empty());
}

TEST(DetectEdges, LeavesOutWhatIsNotValid) {
  const cv::Mat image = HalfPlane(0, 40, 160);
  cv::Mat valid(image.size(), CV_8U, cv::Scalar(255));
  valid.rowRange(0, 30).setTo(0);
  for (const EdgePixel& e : DetectEdges(image, valid, {})) EXPECT_GT(e.pixel.y(), 32);
}

TEST(DetectEdges, LeavesOutSpecks) {
  cv::Mat image(60, 64, CV_8U, cv::Scalar(80));
  image.at<std::uint8_t>(30, 30) = 200;
  EdgeDetectorOptions options;
  options.min_length = 12;
  EXPECT_TRUE(DetectEdges(image, cv::Mat(), options).empty());
}

}  // namespace
}  // namespace evit
