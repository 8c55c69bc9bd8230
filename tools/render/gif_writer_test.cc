#include "tools/render/gif_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <random>

namespace evit::render {
namespace {

// The plain decoder of GIF's codes: strings as whole vectors.
std::vector<std::uint8_t> Decompress(const std::vector<std::uint8_t>& bytes, int bits) {
  const int clear = 1 << bits;
  std::vector<std::vector<std::uint8_t>> strings;
  std::vector<std::uint8_t> result, before;
  int width = bits + 1;
  std::size_t at = 0;
  const auto reset = [&] {
    strings.clear();
    for (int i = 0; i < clear; ++i) strings.push_back({static_cast<std::uint8_t>(i)});
    strings.resize(static_cast<std::size_t>(clear) + 2);
    width = bits + 1;
    before.clear();
  };
  for (;;) {
    std::size_t code = 0;
    for (int k = 0; k < width; ++k, ++at)
      code |= static_cast<std::size_t>(bytes.at(at / 8) >> at % 8 & 1) << k;
    if (static_cast<int>(code) == clear) {
      reset();
      continue;
    }
    if (static_cast<int>(code) == clear + 1) return result;
    std::vector<std::uint8_t> string;
    if (code < strings.size()) {
      string = strings[code];
    } else {
      string = before;
      string.push_back(before.at(0));
    }
    result.insert(result.end(), string.begin(), string.end());
    if (!before.empty() && strings.size() < 4096) {
      before.push_back(string[0]);
      strings.push_back(before);
      if (strings.size() == std::size_t{1} << width && width < 12) ++width;
    }
    before = string;
  }
}

TEST(CompressGif, ComesBackAsItWas) {
  std::mt19937 random(1);
  for (const int colors : {1, 2, 17, 256}) {
    for (const std::size_t n : {0U, 1U, 2U, 255U, 5000U, 200000U}) {
      std::vector<std::uint8_t> indices(n);
      for (std::size_t i = 0; i < n; ++i) {
        indices[i] = static_cast<std::uint8_t>(i % 3 == 0 ? random() % static_cast<unsigned>(colors)
                                                          : i / 100 % static_cast<unsigned>(colors));
      }
      ASSERT_EQ(Decompress(CompressGif(indices, 8), 8), indices) << colors << " colours, " << n << " pixels";
    }
  }
}

TEST(Palette, HasTheColorsThatAreThere) {
  cv::Mat picture(20, 20, CV_8UC3, cv::Scalar(255, 255, 255));
  picture.at<cv::Vec3b>(3, 3) = {200, 30, 10};
  const Palette palette(std::vector<cv::Mat>{picture});
  ASSERT_EQ(palette.colors().size(), 2U);
  EXPECT_EQ(palette.colors()[palette.Nearest({200, 30, 10})], cv::Vec3b(200, 30, 10));
  EXPECT_EQ(palette.colors()[palette.Nearest({190, 60, 40})], cv::Vec3b(200, 30, 10));
  EXPECT_EQ(palette.colors()[palette.Nearest({250, 250, 240})], cv::Vec3b(255, 255, 255));
}

TEST(GifWriter, AReaderSeesEachPicture) {
  const std::string path =
      (std::filesystem::path(::testing::TempDir()) / ("evit_" + std::to_string(getpid()) + ".gif")).string();
  std::vector<cv::Mat> pictures;
  for (int i = 0; i < 4; ++i) {
    cv::Mat picture(48, 64, CV_8UC3, cv::Scalar(248, 248, 248));
    if (i != 2) cv::rectangle(picture, cv::Rect(8 * i, 10, 16, 16), cv::Scalar(8, 80, 200), cv::FILLED);
    pictures.push_back(picture);
  }
  GifWriter writer(path, {64, 48}, 10, Palette(pictures));
  for (const cv::Mat& picture : pictures) writer.Add(picture);
  writer.Close();
  cv::VideoCapture reader(path, cv::CAP_FFMPEG);
  ASSERT_TRUE(reader.isOpened());
  for (const cv::Mat& picture : pictures) {
    cv::Mat read;
    ASSERT_TRUE(reader.read(read));
    EXPECT_LE(cv::norm(read, picture, cv::NORM_INF), 2);
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace evit::render
