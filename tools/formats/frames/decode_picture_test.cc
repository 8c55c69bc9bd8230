#include "tools/formats/frames/decode_picture.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

namespace evit::formats {
namespace {

using ::testing::HasSubstr;

// 4 x 2 pixels in rows of 16 bytes, so that rows have a rest.
StoredPicture Raw(const std::string& encoding, std::vector<std::uint8_t> bytes) {
  bytes.resize(32);
  return {std::move(bytes), encoding, 4, 2, 16, false};
}

std::string Error(const StoredPicture& picture) {
  try {
    DecodeGrey(picture, "the picture");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(DecodePicture, ReadsTheEncodingsOfRos) {
  EXPECT_EQ(DecodeGrey(Raw("mono8", {10, 20, 30, 40}), "").at<std::uint8_t>(0, 2), 30);
  EXPECT_EQ(DecodeGrey(Raw("rgb8", {0, 0, 0, 255, 0, 0}), "").at<std::uint8_t>(0, 1), 76);
  EXPECT_EQ(DecodeGrey(Raw("bgr8", {0, 0, 0, 255, 0, 0}), "").at<std::uint8_t>(0, 1), 29);
  EXPECT_EQ(DecodeGrey(Raw("bgra8", {0, 0, 0, 0, 255, 0, 0, 9}), "").at<std::uint8_t>(0, 1), 29);
  const cv::Mat grey = DecodeGrey(Raw("mono8", {1}), "");
  EXPECT_EQ(grey.type(), CV_8UC1);
  EXPECT_EQ(grey.size(), cv::Size(4, 2));
}

// A camera of 12 bits leaves the upper four empty.
TEST(DecodePicture, OfMoreBitsTheUpperEightStay) {
  EXPECT_EQ(DecodeGrey(Raw("mono16", {0, 0, 0xff, 0x0f}), "").at<std::uint8_t>(0, 1), 255);
  EXPECT_EQ(DecodeGrey(Raw("mono16", {0, 0x80, 0xff, 0xff}), "").at<std::uint8_t>(0, 0), 128);
  StoredPicture big = Raw("mono16", {0x80, 0, 0xff, 0xff});
  big.big_endian = true;
  EXPECT_EQ(DecodeGrey(big, "").at<std::uint8_t>(0, 0), 128);
}

TEST(DecodePicture, DepthIsInMetres) {
  const cv::Mat depth = DecodeDepth(Raw("16UC1", {0x88, 0x13, 0, 0}), 5000, "");  // 5000
  EXPECT_EQ(depth.type(), CV_32FC1);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 0), 1);
  EXPECT_EQ(depth.at<float>(0, 1), 0);
  // Floats are metres whatever the scale; what is not finite is not a depth.
  StoredPicture floats = Raw("32FC1", {0, 0, 0, 0x40, 0, 0, 0xc0, 0x7f});
  EXPECT_FLOAT_EQ(DecodeDepth(floats, 5000, "").at<float>(0, 0), 2);
  EXPECT_EQ(DecodeDepth(floats, 5000, "").at<float>(0, 1), 0);
  EXPECT_THROW(DecodeDepth(Raw("mono8", {}), 1000, ""), std::runtime_error);
}

TEST(DecodePicture, ErrorsNameThePictureAndWhatIsWrong) {
  EXPECT_THAT(Error(Raw("nv21", {})),
              HasSubstr("the picture: encoding \"nv21\" is not known; known are mono8"));
  StoredPicture cut = Raw("mono8", {});
  cut.bytes.resize(17);
  EXPECT_THAT(Error(cut), HasSubstr("holds 17 bytes"));
  StoredPicture narrow = Raw("bgr8", {});
  narrow.step = 4;
  EXPECT_THAT(Error(narrow), HasSubstr("in rows of 4 bytes"));
  StoredPicture forged = Raw("mono8", {});
  forged.width = forged.height = forged.step = 0xffffffffU;
  EXPECT_THAT(Error(forged), HasSubstr("4294967295x"));
  StoredPicture file;
  file.bytes = {0x89, 'P', 'N', 'G', 1, 2, 3};
  EXPECT_THAT(Error(file), HasSubstr("cannot be read as a picture"));
}

}  // namespace
}  // namespace evit::formats
