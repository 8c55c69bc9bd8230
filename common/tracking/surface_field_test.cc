#include "common/tracking/surface_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace evit {
namespace {

cv::Mat RandomSurface() {
  cv::Mat noise(120, 160, CV_8UC1), smooth;
  cv::RNG rng(3);
  rng.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(noise, smooth, {0, 0}, 1.0);
  return smooth;
}

TEST(SurfaceField, GradientIsTheValuesDerivativeOnEveryLevel) {
  const SurfaceField field(RandomSurface(), 3);
  cv::RNG rng(5);
  for (int k = 0; k < 500; ++k) {
    const int level = k % 3;
    // On a grid that single precision holds exactly.
    const double x = rng.uniform(10 * 512, 140 * 512) / 512.0, y = rng.uniform(10 * 512, 100 * 512) / 512.0;
    const double h = 1.0 / 512;
    const auto s = field.At(level, x, y);
    const double gx = (field.At(level, x + h, y).value - field.At(level, x - h, y).value) / (2 * h);
    const double gy = (field.At(level, x, y + h).value - field.At(level, x, y - h).value) / (2 * h);
    EXPECT_NEAR(s.gx, gx, 0.1);  // float taps: the numeric derivative is the coarse one
    EXPECT_NEAR(s.gy, gy, 0.1);
  }
}

TEST(SurfaceField, IsContinuousAcrossPixelBorders) {
  const SurfaceField field(RandomSurface(), 1);
  for (int x = 20; x < 140; ++x) {
    const auto a = field.At(0, x + 0.5 - 1e-6, 50.3), b = field.At(0, x + 0.5 + 1e-6, 50.3);
    EXPECT_NEAR(a.value, b.value, 1e-2);
    EXPECT_NEAR(a.gx, b.gx, 1e-2);
  }
}

TEST(SurfaceField, LinearRampIsReproduced) {
  cv::Mat ramp(60, 80, CV_8UC1);
  for (int y = 0; y < ramp.rows; ++y) {
    for (int x = 0; x < ramp.cols; ++x) ramp.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(2 * x + y);
  }
  const SurfaceField field(ramp, 1);
  const auto s = field.At(0, 30.3, 20.8);
  EXPECT_NEAR(s.value, 2 * 30.3 + 20.8, 1e-3);
  EXPECT_NEAR(s.gx, 2, 1e-4);
  EXPECT_NEAR(s.gy, 1, 1e-4);
}

// As in a program that has each surface in a buffer of its own.
TEST(SurfaceField, OutlivesAnImageWithoutAnOwner) {
  const cv::Mat surface = RandomSurface();
  std::vector<std::uint8_t> buffer(surface.data, surface.data + surface.total());
  const SurfaceField owned(surface, 1);
  const SurfaceField field(cv::Mat(surface.rows, surface.cols, CV_8UC1, buffer.data()), 1);
  std::fill(buffer.begin(), buffer.end(), std::uint8_t{0});
  EXPECT_EQ(field.At(0, 30.3, 20.8).value, owned.At(0, 30.3, 20.8).value);
}

TEST(SurfaceField, OutsideItDoesNotPull) {
  const SurfaceField field(RandomSurface(), 1);
  const auto s = field.At(0, -50, 1e6);
  EXPECT_EQ(s.gx, 0);
  EXPECT_EQ(s.gy, 0);
  EXPECT_GE(s.value, 0);
  EXPECT_LE(s.value, 255);
}

}  // namespace
}  // namespace evit
