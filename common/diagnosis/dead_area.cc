#include "common/diagnosis/dead_area.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kLeastShare = 0.005;  // of the sensor
constexpr double kLeastFired = 0.2;    // of the pixels along each edge
constexpr double kAlike = 0.6;         // of the share that fires further out
constexpr int kFurther = 6;            // pixels
constexpr double kRareness = 1e-4;
constexpr double kTogether = 6;      // pixels along an edge that fire for one cause
constexpr double kStray = 0.01;      // of what a pixel fires usually: damaged data, not a pixel
constexpr std::uint32_t kMost = 10;  // times what a pixel fires usually; the rest of a hot one is not counted

/// Sums over parts of rows and columns of an image.
class LineSums {
 public:
  LineSums(int width, int height)
      : width_(width),
        along_row_(static_cast<std::size_t>((width + 1) * (height + 1))),
        along_column_(along_row_.size()) {}
  /// Each pixel once, in order.
  void Put(int x, int y, std::int64_t value) {
    along_row_[At(x + 1, y)] = along_row_[At(x, y)] + value;
    along_column_[At(x, y + 1)] = along_column_[At(x, y)] + value;
  }
  std::int64_t InRow(int y, int left, int right) const {
    return along_row_[At(right + 1, y)] - along_row_[At(left, y)];
  }
  std::int64_t InColumn(int x, int top, int bottom) const {
    return along_column_[At(x, bottom + 1)] - along_column_[At(x, top)];
  }

 private:
  std::size_t At(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x);
  }
  int width_;
  std::vector<std::int64_t> along_row_, along_column_;  // of the pixels before each
};

/// Which pixels fired, and how often.
class FiredPixels {
 public:
  explicit FiredPixels(const EventCensus& e)
      : width_(e.width()),
        height_(e.height()),
        counts_(e.by_pixel()),
        fired_(width_, height_),
        events_(width_, height_) {
    const std::uint32_t usual = UsualCount();
    limit_ = static_cast<std::uint32_t>(kStray * usual);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        fired_.Put(x, y, Fired(x, y) ? 1 : 0);
        events_.Put(x, y, std::min(Count(x, y), kMost * usual));
      }
    }
  }
  int width() const { return width_; }
  int height() const { return height_; }
  bool Fired(int x, int y) const { return Count(x, y) > limit_; }
  const LineSums& fired() const { return fired_; }
  const LineSums& events() const { return events_; }  // those of a hot pixel only in part
  // Of the pixels with a silent one to the left or above, the share that fired.
  double ShareBesideSilent() const {
    std::int64_t n = 0, fired = 0;
    for (int y = 1; y < height_; ++y) {
      for (int x = 1; x < width_; ++x) {
        if (Fired(x - 1, y) && Fired(x, y - 1)) continue;
        ++n, fired += Fired(x, y) ? 1 : 0;
      }
    }
    return n > 0 ? static_cast<double>(fired) / static_cast<double>(n) : 0;
  }

 private:
  std::uint32_t Count(int x, int y) const {
    return counts_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }
  // Median of those that fired.
  std::uint32_t UsualCount() const {
    std::vector<std::uint32_t> fired;
    for (const std::uint32_t n : counts_)
      if (n > 0) fired.push_back(n);
    if (fired.empty()) return 0;
    const auto middle = fired.begin() + static_cast<std::ptrdiff_t>(fired.size() / 2);
    std::nth_element(fired.begin(), middle, fired.end());
    return *middle;
  }

  int width_, height_;
  const std::vector<std::uint32_t>& counts_;
  std::uint32_t limit_ = 0;  // events of a pixel that counts as silent
  LineSums fired_, events_;
};

// Bound (Chernoff's) of the chance of so many of n where a share of p is usual.
double Chance(double fired, double n, double p) {
  const double q = fired / n;
  if (n < 1 || q <= p) return 1;
  p = std::max(p, 1e-6);
  double exponent = q * std::log(q / p);
  if (q < 1) exponent += (1 - q) * std::log((1 - q) / (1 - p));
  return std::exp(-n * exponent);
}

// Pixels along one edge of an area, some pixels outside of it.
struct Beside {
  std::int64_t n = 0, fired = 0, events = 0;
  double Share() const { return n > 0 ? static_cast<double>(fired) / static_cast<double>(n) : 0; }
  double Mean() const { return n > 0 ? static_cast<double>(events) / static_cast<double>(n) : 0; }
};

enum class Edge { kLeft, kRight, kTop, kBottom };

// Of the line nearest to the area, or `from` to `to` pixels away; none beyond the sensor.
Beside CountBeside(const FiredPixels& pixels, const DeadArea& area, Edge edge, int from, int to) {
  const bool column = edge == Edge::kLeft || edge == Edge::kRight;
  Beside sum;
  for (int away = from; away <= to; ++away) {
    const int at = edge == Edge::kLeft    ? area.left - away
                   : edge == Edge::kRight ? area.right + away
                   : edge == Edge::kTop   ? area.top - away
                                          : area.bottom + away;
    if (at < 0 || at >= (column ? pixels.width() : pixels.height())) break;
    const auto count = [&](const LineSums& sums) {
      return column ? sums.InColumn(at, area.top, area.bottom) : sums.InRow(at, area.left, area.right);
    };
    sum.n += column ? area.height() : area.width();
    sum.fired += count(pixels.fired()), sum.events += count(pixels.events());
  }
  return sum;
}

// Whether along each edge about as many pixels fire, and as often, as further out; fills in the counts. Where
// a scene is plain, what fires touches the largest rectangle within here and there only; and where it has a
// straight edge, that comes as far as the area's less often than further out.
bool LookBeside(const FiredPixels& pixels, DeadArea* area) {
  for (const Edge edge : {Edge::kLeft, Edge::kRight, Edge::kTop, Edge::kBottom}) {
    const Beside near = CountBeside(pixels, *area, edge, 1, 1),
                 further = CountBeside(pixels, *area, edge, 2, kFurther);
    if (near.n == 0) continue;  // the sensor's own edge
    if (near.Share() < std::max(kLeastFired, kAlike * further.Share())) return false;
    if (near.Mean() < kAlike * further.Mean()) return false;
    area->beside += static_cast<int>(near.n), area->beside_fired += static_cast<int>(near.fired);
  }
  return area->beside > 0;
}

// That edges are so busy by chance, and that so many pixels are silent by chance: each explains less than the
// other where few pixels fire, or nearly all.
double ChanceOf(const DeadArea& area) {
  const double size = static_cast<double>(area.width()) * area.height();
  const double silent = std::pow(1 - std::min(area.usual, 0.999), size / (kTogether * kTogether));
  return std::min(silent, Chance(area.beside_fired / kTogether, area.beside / kTogether, area.usual));
}

}  // namespace

std::optional<DeadArea> FindDeadArea(const EventCensus& events) {
  const FiredPixels pixels(events);
  const int width = pixels.width(), height = pixels.height();
  const double usual = pixels.ShareBesideSilent();
  std::optional<DeadArea> best;
  double largest = kLeastShare * width * height;
  // Each rectangle of silent pixels that cannot grow ends where a column of them, seen from its lowest row,
  // is shorter than its neighbour (the largest rectangle under a histogram).
  std::vector<int> silent(static_cast<std::size_t>(width) + 1, 0);  // pixels upwards from the row
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      int& n = silent[static_cast<std::size_t>(x)];
      n = pixels.Fired(x, y) ? 0 : n + 1;
    }
    std::vector<std::pair<int, int>> open;  // first column and height
    for (int x = 0; x <= width; ++x) {
      const int now = silent[static_cast<std::size_t>(x)];
      int begin = x;
      while (!open.empty() && open.back().second > now) {
        begin = open.back().first;
        DeadArea area{begin, y - open.back().second + 1, x - 1, y};
        open.pop_back();
        const double size = static_cast<double>(area.width()) * area.height();
        if (size <= largest || (y + 1 < height && pixels.fired().InRow(y + 1, area.left, area.right) == 0))
          continue;
        if (!LookBeside(pixels, &area)) continue;
        area.usual = usual;
        area.chance = ChanceOf(area);
        if (area.chance > kRareness) continue;
        largest = size;
        best = area;
      }
      if (now > 0 && (open.empty() || open.back().second < now)) open.emplace_back(begin, now);
    }
  }
  return best;
}

Finding CheckDeadArea(const EventCensus& e) {
  const std::optional<DeadArea> area = FindDeadArea(e);
  if (!area) return Good("dead-area", "no straight-edged area without events");
  const double share =
      static_cast<double>(area->width()) * area->height() / (static_cast<double>(e.width()) * e.height());
  return {"dead-area", share > 0.25 ? Severity::kError : Severity::kWarning,
          FormatText("of %d pixels along its edges %d fire (beside other silent pixels %.0f %%)",
                     area->beside, area->beside_fired, 100 * area->usual),
          FormatText("The pixels (%d, %d) to (%d, %d), %.1f %% of the sensor, give no events.", area->left,
                     area->top, area->right, area->bottom, 100 * share),
          "look for a region of interest, masked columns or rows, or a crop in camera and driver; if the "
          "sensor is "
          "broken there, EVIT tracks with the rest"};
}

}  // namespace evit::diagnosis
