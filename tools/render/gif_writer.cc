#include "tools/render/gif_writer.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace evit::render {
namespace {

constexpr std::uint8_t kUnchanged = 255;  // index of the transparent colour

std::uint8_t Low(int value) { return static_cast<std::uint8_t>(value & 255); }
std::uint8_t High(int value) { return static_cast<std::uint8_t>(value >> 8 & 255); }

// Codes of changing width, least significant bit first.
class BitWriter {
 public:
  void Put(int code, int width) {
    buffer_ |= static_cast<std::uint32_t>(code) << filled_;
    for (filled_ += width; filled_ >= 8; filled_ -= 8, buffer_ >>= 8) {
      bytes_.push_back(static_cast<std::uint8_t>(buffer_ & 255U));
    }
  }
  std::vector<std::uint8_t> Take() {
    if (filled_ > 0) bytes_.push_back(static_cast<std::uint8_t>(buffer_ & 255U));
    return std::move(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::uint32_t buffer_ = 0;
  int filled_ = 0;
};

}  // namespace

Palette::Palette(const std::vector<cv::Mat>& samples) : nearest_(32768) {
  std::map<int, std::pair<int, cv::Vec3b>> counts;
  for (const cv::Mat& picture : samples) {
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        const auto& color = picture.at<cv::Vec3b>(y, x);
        auto& [count, sample] = counts[color[0] >> 3 << 10 | color[1] >> 3 << 5 | color[2] >> 3];
        if (++count == 1) sample = color;
      }
    }
  }
  std::vector<std::pair<int, cv::Vec3b>> by_count;
  by_count.reserve(counts.size());
  for (const auto& [key, value] : counts) by_count.push_back(value);
  std::stable_sort(by_count.begin(), by_count.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < std::min<std::size_t>(by_count.size(), 255); ++i) {
    colors_.push_back(by_count[i].second);
  }
  if (colors_.empty()) colors_.emplace_back(0, 0, 0);
  for (int key = 0; key < 32768; ++key) {
    const cv::Vec3i middle((key >> 10 << 3) + 4, (key >> 5 & 31) * 8 + 4, (key & 31) * 8 + 4);
    int best = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < colors_.size(); ++i) {
      const cv::Vec3i d = cv::Vec3i(colors_[i]) - middle;
      const int distance = d.dot(d);
      if (distance >= best) continue;
      best = distance;
      nearest_[static_cast<std::size_t>(key)] = static_cast<std::uint8_t>(i);
    }
  }
}

std::vector<std::uint8_t> CompressGif(const std::vector<std::uint8_t>& indices, int bits) {
  constexpr int kMostCodes = 4096;
  const int clear = 1 << bits, end = clear + 1;
  BitWriter writer;
  // Where a known string (code) continues with an index: [code][index], 0 nowhere.
  std::vector<std::uint16_t> next(static_cast<std::size_t>(kMostCodes) << bits);
  int width = bits + 1, free = end + 1, current = -1;
  writer.Put(clear, width);
  for (const std::uint8_t index : indices) {
    if (current < 0) {
      current = index;
      continue;
    }
    std::uint16_t& known = next[static_cast<std::size_t>(current) << bits | index];
    if (known != 0) {
      current = known;
      continue;
    }
    writer.Put(current, width);
    current = index;
    if (free == kMostCodes) {
      writer.Put(clear, width);
      std::fill(next.begin(), next.end(), 0);
      width = bits + 1;
      free = end + 1;
      continue;
    }
    // A reader is one string behind: its codes become wider one later.
    if (free == 1 << width) ++width;
    known = static_cast<std::uint16_t>(free++);
  }
  if (current >= 0) writer.Put(current, width);
  writer.Put(end, width);
  return writer.Take();
}

GifWriter::GifWriter(const std::string& path, cv::Size size, int delay_cs, const Palette& palette)
    : path_(path),
      file_(std::fopen(path.c_str(), "wb")),
      size_(size),
      delay_cs_(delay_cs),
      palette_(palette) {
  if (!file_) throw std::runtime_error("cannot write " + path);
  std::vector<std::uint8_t> head = {
      'G',  'I', 'F', '8', '9', 'a', Low(size.width), High(size.width), Low(size.height), High(size.height),
      0xF7, 0,   0};
  for (std::size_t i = 0; i < 256; ++i) {
    const cv::Vec3b color = i < palette_.colors().size() ? palette_.colors()[i] : cv::Vec3b(0, 0, 0);
    head.insert(head.end(), {color[2], color[1], color[0]});
  }
  const char repeat[] = "\x21\xFF\x0BNETSCAPE2.0\x03\x01\x00\x00";  // with the terminating zero
  head.insert(head.end(), repeat, repeat + sizeof repeat);
  Put(head);
}

void GifWriter::Put(const std::vector<std::uint8_t>& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    throw std::runtime_error("cannot write " + path_ + ": is the disk full?");
  }
}

void GifWriter::PutPart(const cv::Mat& indices, const cv::Rect& part, bool whole) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(static_cast<std::size_t>(part.area()));
  for (int y = part.y; y < part.y + part.height; ++y) {
    for (int x = part.x; x < part.x + part.width; ++x) {
      const std::uint8_t index = indices.at<std::uint8_t>(y, x);
      pixels.push_back(!whole && index == shown_.at<std::uint8_t>(y, x) ? kUnchanged : index);
    }
  }
  std::vector<std::uint8_t> block = {0x21,       0xF9, 4,   0x05, Low(delay_cs_), High(delay_cs_),
                                     kUnchanged, 0,    0x2C};
  for (const int value : {part.x, part.y, part.width, part.height}) {
    block.insert(block.end(), {Low(value), High(value)});
  }
  block.insert(block.end(), {0, 8});
  const std::vector<std::uint8_t> codes = CompressGif(pixels, 8);
  for (std::size_t at = 0; at < codes.size(); at += 255) {
    const std::size_t n = std::min<std::size_t>(255, codes.size() - at);
    block.push_back(static_cast<std::uint8_t>(n));
    block.insert(block.end(), codes.begin() + static_cast<std::ptrdiff_t>(at),
                 codes.begin() + static_cast<std::ptrdiff_t>(at + n));
  }
  block.push_back(0);
  Put(block);
}

void GifWriter::Add(const cv::Mat& picture) {
  cv::Mat indices(size_, CV_8U);
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      indices.at<std::uint8_t>(y, x) = palette_.Nearest(picture.at<cv::Vec3b>(y, x));
    }
  }
  const bool whole = shown_.empty();
  cv::Rect part(0, 0, size_.width, size_.height);
  if (!whole) {
    part = cv::Rect();
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) {
        if (indices.at<std::uint8_t>(y, x) != shown_.at<std::uint8_t>(y, x)) part |= cv::Rect(x, y, 1, 1);
      }
    }
    if (part.empty()) part = cv::Rect(0, 0, 1, 1);  // for its time
  }
  PutPart(indices, part, whole);
  shown_ = indices;
}

void GifWriter::Close() {
  Put({0x3B});
  if (std::fclose(file_.release()) != 0) {
    throw std::runtime_error("cannot write " + path_ + ": is the disk full?");
  }
}

}  // namespace evit::render
