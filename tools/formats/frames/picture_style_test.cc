#include "tools/formats/frames/picture_style.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/helpers/painted_scene.h"

namespace evit::formats {
namespace {

StoredPicture Png(const cv::Mat& picture) {
  StoredPicture stored;
  cv::imencode(".png", picture, stored.bytes);
  return stored;
}

class PictureStyleTest : public testing::Test {
 protected:
  PictureStyleTest() {
    Camera camera;
    camera.width = 160, camera.height = 120;
    camera.fx = camera.fy = 120;
    camera.cx = 80, camera.cy = 60;
    grey_ = PaintedScene::Wall().Picture(camera, PaintedScene::Poses(1, 0)[0]);
  }
  // As a colour sensor sees the scene in light that is rather green: R G / G B.
  cv::Mat Mosaic() const {
    cv::Mat mosaic = grey_.clone();
    for (int row = 0; row < mosaic.rows; ++row) {
      for (int column = 0; column < mosaic.cols; ++column) {
        const double gain = (row + column) % 2 == 1 ? 1 : (row % 2 == 0 ? 0.6 : 0.45);
        mosaic.at<std::uint8_t>(row, column) =
            cv::saturate_cast<std::uint8_t>(gain * grey_.at<std::uint8_t>(row, column));
      }
    }
    return mosaic;
  }
  cv::Mat Levels(double full) const {
    cv::Mat levels;
    grey_.convertTo(levels, CV_16U, full / 255);
    return levels;
  }

  cv::Mat grey_;
};

// A dark picture of 12 bits alone looks like one of 10.
TEST_F(PictureStyleTest, AllPicturesOfACameraAreScaledAlike) {
  const StoredPicture bright = Png(Levels(4095)), dark = Png(Levels(900));
  const PictureStyle style = StyleOf({dark, bright, StoredPicture{}});
  EXPECT_EQ(style.white, 4095);
  const auto mean = [&](const StoredPicture& picture, const PictureStyle& with) {
    return cv::mean(DecodeGrey(picture, "", with))[0];
  };
  EXPECT_NEAR(mean(bright, style) / mean(dark, style), 4095.0 / 900, 0.1);
  EXPECT_LT(mean(bright, {}) / mean(dark, {}), 1.3) << "by each picture alone";
  const cv::Mat brighter = DecodeGrey(Png(Levels(8000)), "", style);
  EXPECT_LT(cv::countNonZero(brighter == 255), brighter.total() / 10)
      << "brighter than all that were sampled";
  EXPECT_EQ(StyleOf({Png(Levels(16000))}).white, 16383);
  EXPECT_EQ(StyleOf({Png(Levels(40000))}).white, 65535);
  EXPECT_EQ(cv::countNonZero(DecodeGrey(Png(grey_), "", StyleOf({Png(grey_)})) != grey_), 0);
}

TEST_F(PictureStyleTest, AMosaicIsToldFromPicturesAndNoise) {
  EXPECT_TRUE(StyleOf({Png(Mosaic())}).mosaic);
  EXPECT_FALSE(StyleOf({Png(grey_)}).mosaic);
  cv::Mat noise(grey_.size(), CV_8U), colour;
  cv::setRNGSeed(1);
  cv::randu(noise, 0, 255);
  EXPECT_FALSE(StyleOf({Png(noise)}).mosaic);
  cv::cvtColor(Mosaic(), colour, cv::COLOR_GRAY2BGR);
  EXPECT_FALSE(StyleOf({Png(colour)}).mosaic) << "three channels are none";
  EXPECT_FALSE(StyleOf({}).mosaic);
}

// 65 % of what a grey camera sees, softer; edges stay where they are.
TEST_F(PictureStyleTest, AMosaicBecomesAnEvenPicture) {
  const StoredPicture stored = Png(Mosaic());
  cv::Mat even = DecodeGrey(stored, "", StyleOf({stored})), expected, off;
  const cv::Mat kernel = (cv::Mat_<float>(1, 3) << 0.25, 0.5, 0.25);
  cv::sepFilter2D(grey_, expected, CV_32F, kernel, kernel);
  even.convertTo(even, CV_32F, 1 / ((1 + 1 + 0.6 + 0.45) / 4));
  cv::absdiff(even, expected, off);
  EXPECT_LT(cv::mean(off)[0], 2);
}

}  // namespace
}  // namespace evit::formats
