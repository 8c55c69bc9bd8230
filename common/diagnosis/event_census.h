#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/events/event.h"

namespace evit::diagnosis {

/// What checks need to know of a recording's events, gathered in one pass. Memory: 13 bytes a pixel, 8 a
/// millisecond, 24 times more in the first minute.
class EventCensus {
 public:
  static constexpr Utime kBin = 1000;  // us

  /// Pixels of the sensor by the rig file; events outside are counted.
  EventCensus(int width, int height);

  /// In the order of the recording.
  void Add(const EventArray& events);

  int width() const { return width_; }
  int height() const { return height_; }
  std::int64_t count() const { return count_; }
  std::int64_t brighter() const { return brighter_; }
  std::int64_t outside() const { return outside_; }
  /// With a stamp before that of the event in front of it.
  std::int64_t backward() const { return backward_; }
  /// Different stamps, one behind the other: how finely time is told.
  std::int64_t stamps() const { return stamps_; }
  /// Of every fourth event: whether any of the 24 pixels around had fired within a time before it. Those of
  /// an edge had; noise has company by chance only.
  struct Company {
    static constexpr std::array<Utime, 5> kWithin = {10'000, 5'000, 2'500, 1'250, 625};  // us
    std::int64_t judged = 0;
    std::array<std::int64_t, kWithin.size()> alone{};  // in each of these times
    std::int64_t alike = 0, unlike = 0;  // polarity as the newest one's within the longest time, or not
    static constexpr int kPixels = 24;
  };
  const Company& company() const { return company_; }
  Utime first() const { return first_; }
  Utime last() const { return last_; }
  double seconds() const { return count_ > 1 ? ToSeconds(last_ - first_) : 0; }
  /// Largest column and row seen anywhere, -1 where there was no event.
  int max_x() const { return max_x_; }
  int max_y() const { return max_y_; }
  /// Events of each pixel, row by row.
  const std::vector<std::uint32_t>& by_pixel() const { return by_pixel_; }

  struct Bin {
    std::uint32_t brighter = 0, darker = 0;
  };
  /// Events by millisecond since the first one; at most an hour.
  const std::vector<Bin>& bins() const { return bins_; }
  /// The same of each of kTilesX times kTilesY parts of the image, row by row; of the first minute.
  static constexpr int kTilesX = 6, kTilesY = 4;
  const std::vector<std::vector<Bin>>& tiles() const { return tiles_; }

 private:
  void JudgeCompany(Utime t, int x, int y, std::uint8_t polarity);

  int width_, height_;
  std::int64_t count_ = 0, brighter_ = 0, outside_ = 0, backward_ = 0, stamps_ = 0;
  Company company_;
  Utime first_ = 0, last_ = 0, newest_ = 0;
  int max_x_ = -1, max_y_ = -1;
  std::vector<std::uint32_t> by_pixel_;
  std::vector<Utime> fired_;            // newest event of each pixel
  std::vector<std::uint8_t> polarity_;  // of that
  std::vector<Bin> bins_;
  std::vector<std::vector<Bin>> tiles_;
};

}  // namespace evit::diagnosis
