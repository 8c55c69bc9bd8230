#include "tools/formats/frames/decode_picture.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace evit::formats {
namespace {

struct Encoding {
  const char* name;
  int type;     // OpenCV's
  int to_grey;  // cv::cvtColor's; -1: is grey
};

// sensor_msgs/image_encodings.
constexpr Encoding kEncodings[] = {
    {"mono8", CV_8UC1, -1},
    {"8UC1", CV_8UC1, -1},
    {"mono16", CV_16UC1, -1},
    {"16UC1", CV_16UC1, -1},
    {"32FC1", CV_32FC1, -1},
    {"bgr8", CV_8UC3, cv::COLOR_BGR2GRAY},
    {"8UC3", CV_8UC3, cv::COLOR_BGR2GRAY},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2GRAY},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2GRAY},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2GRAY},
    {"bgr16", CV_16UC3, cv::COLOR_BGR2GRAY},
    {"rgb16", CV_16UC3, cv::COLOR_RGB2GRAY},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerRGGB2GRAY},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerBGGR2GRAY},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGBRG2GRAY},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGRBG2GRAY},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2},
};

const Encoding& EncodingOf(const StoredPicture& picture, const std::string& name) {
  for (const Encoding& e : kEncodings) {
    if (picture.encoding == e.name) return e;
  }
  std::string known;
  for (const Encoding& e : kEncodings) known += std::string(known.empty() ? "" : ", ") + e.name;
  throw std::runtime_error(name + ": encoding \"" + picture.encoding + "\" is not known; known are " + known);
}

cv::Mat Unpack(const StoredPicture& picture, const Encoding& encoding, const std::string& name) {
  const std::size_t row = static_cast<std::size_t>(picture.width) * CV_ELEM_SIZE(encoding.type);
  if (picture.width == 0 || picture.height == 0 || picture.width > 16384 || picture.height > 16384 ||
      picture.step < row ||
      picture.bytes.size() < static_cast<std::size_t>(picture.step) * (picture.height - 1) + row) {
    throw std::runtime_error(name + ": says " + std::to_string(picture.width) + "x" +
                             std::to_string(picture.height) + " " + picture.encoding + " in rows of " +
                             std::to_string(picture.step) + " bytes, but holds " +
                             std::to_string(picture.bytes.size()) + " bytes");
  }
  cv::Mat image = cv::Mat(static_cast<int>(picture.height), static_cast<int>(picture.width), encoding.type,
                          const_cast<std::uint8_t*>(picture.bytes.data()), picture.step)
                      .clone();
  if (picture.big_endian && image.elemSize1() == 2) {
    for (int r = 0; r < image.rows; ++r) {
      auto* at = image.ptr<std::uint16_t>(r);
      for (int c = 0; c < image.cols * image.channels(); ++c)
        at[c] = static_cast<std::uint16_t>(at[c] << 8 | at[c] >> 8);
    }
  }
  return image;
}

cv::Mat Decompress(const StoredPicture& picture, int flags, const std::string& name) {
  cv::Mat image;
  try {
    if (!picture.bytes.empty()) image = cv::imdecode(picture.bytes, flags);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty())
    throw std::runtime_error(name + ": cannot be read as a picture: damaged, cut off, or none");
  return image;
}

}  // namespace

cv::Mat DecodeLevels(const StoredPicture& picture, const std::string& name, bool* is_raw) {
  cv::Mat levels;
  if (picture.encoding.empty()) {
    const int flags = is_raw == nullptr ? cv::IMREAD_GRAYSCALE : cv::IMREAD_ANYCOLOR;
    levels = Decompress(picture, cv::IMREAD_ANYDEPTH | flags, name);
    if (is_raw != nullptr) *is_raw = levels.channels() == 1;
    if (levels.channels() == 3) cv::cvtColor(levels, levels, cv::COLOR_BGR2GRAY);
  } else {
    const Encoding& encoding = EncodingOf(picture, name);
    levels = Unpack(picture, encoding, name);
    if (is_raw != nullptr) *is_raw = encoding.to_grey < 0;
    if (encoding.to_grey >= 0) cv::cvtColor(levels, levels, encoding.to_grey);
  }
  if (levels.type() != CV_8UC1 && levels.type() != CV_16UC1)
    throw std::runtime_error(name + ": expected 8 or 16 bits per channel");
  return levels;
}

double WhiteOf(const cv::Mat& levels) {
  if (levels.depth() == CV_8U) return 255;
  double most = 0;
  cv::minMaxLoc(levels, nullptr, &most);
  for (const int bits : {10, 12, 14}) {
    const double white = (1 << bits) - 1;
    if (most <= white) return white;
  }
  return 65535;
}

cv::Mat DecodeGrey(const StoredPicture& picture, const std::string& name, const PictureStyle& style) {
  cv::Mat levels = DecodeLevels(picture, name);
  if (style.mosaic) {
    // Each pixel gets all four of a pattern in equal parts, wherever the pattern begins, and no edge moves.
    const cv::Mat kernel = (cv::Mat_<float>(1, 3) << 0.25, 0.5, 0.25);
    cv::sepFilter2D(levels, levels, -1, kernel, kernel, {-1, -1}, 0, cv::BORDER_REFLECT_101);
  }
  if (levels.depth() == CV_8U) return levels;
  cv::Mat bytes;
  levels.convertTo(bytes, CV_8U, 255 / std::max(style.white > 255 ? style.white : 0, WhiteOf(levels)));
  return bytes;
}

cv::Mat DecodeDepth(const StoredPicture& picture, double units_per_metre, const std::string& name) {
  const cv::Mat image = picture.encoding.empty()
                            ? Decompress(picture, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR, name)
                            : Unpack(picture, EncodingOf(picture, name), name);
  if (image.type() != CV_16UC1 && image.type() != CV_32FC1) {
    throw std::runtime_error(name + ": is not a depth image: expected one channel of 16 bits" +
                             (image.depth() == CV_8U ? ", not of 8 (a picture for people?)" : ""));
  }
  cv::Mat metres;
  image.convertTo(metres, CV_32F, image.depth() == CV_16U ? 1 / units_per_metre : 1);
  for (int r = 0; r < metres.rows; ++r) {
    auto* row = metres.ptr<float>(r);
    std::replace_if(
        row, row + metres.cols, [](float z) { return !(z > 0 && z < 1000); }, 0.0F);
  }
  return metres;
}

}  // namespace evit::formats
