#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace evit::render {

/// Up to 255 colours and the nearest of them for any other.
class Palette {
 public:
  /// The most frequent colours of these pictures (BGR), told apart to five bits.
  explicit Palette(const std::vector<cv::Mat>& samples);

  std::uint8_t Nearest(const cv::Vec3b& color) const {
    return nearest_[static_cast<std::size_t>(color[0] >> 3 << 10 | color[1] >> 3 << 5 | color[2] >> 3)];
  }
  const std::vector<cv::Vec3b>& colors() const { return colors_; }

 private:
  std::vector<cv::Vec3b> colors_;
  std::vector<std::uint8_t> nearest_;  // [32768], by five bits of B, G and R
};

/// Lempel-Ziv-Welch as GIF has it: `indices` in codes that start with `bits` + 1 bits.
std::vector<std::uint8_t> CompressGif(const std::vector<std::uint8_t>& indices, int bits);

/// An animated GIF (GIF89a) that repeats for ever. Of each picture only the part that has changed is stored.
class GifWriter {
 public:
  /// `delay_cs`: hundredths of a second a picture is shown. Throws std::runtime_error naming the file where
  /// it cannot be made.
  GifWriter(const std::string& path, cv::Size size, int delay_cs, const Palette& palette);

  /// BGR, of the size given.
  void Add(const cv::Mat& picture);
  /// Throws std::runtime_error where the disk takes no more.
  void Close();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void Put(const std::vector<std::uint8_t>& bytes);
  void PutPart(const cv::Mat& indices, const cv::Rect& part, bool whole);

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  cv::Size size_;
  int delay_cs_;
  const Palette palette_;
  cv::Mat shown_;  // indices of the picture before
};

}  // namespace evit::render
