#include "common/diagnosis/dead_area.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace evit::diagnosis {
namespace {

constexpr double kLeastShare = 0.005;  // of the sensor
constexpr double kLeastFired = 0.2;    // of the pixels along each edge
constexpr double kAlike = 0.6;         // of the share that fires further out
constexpr int kFurther = 6;            // pixels
constexpr double kRareness = 1e-4;
constexpr double kTogether = 6;  // pixels along an edge that fire for one cause
constexpr double kStray = 0.01;  // of what a pixel fires usually: damaged data, not a pixel

/// Which pixels fired, with the sums that count them along any row or column.
class FiredPixels {
 public:
  explicit FiredPixels(const EventCensus& e)
      : width_(e.width()), height_(e.height()), limit_(Limit(e.by_pixel())), counts_(e.by_pixel()) {
    const auto n = static_cast<std::size_t>((width_ + 1) * (height_ + 1));
    along_row_.resize(n);
    along_column_.resize(n);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        along_row_[At(x + 1, y)] = along_row_[At(x, y)] + (Fired(x, y) ? 1 : 0);
        along_column_[At(x, y + 1)] = along_column_[At(x, y)] + (Fired(x, y) ? 1 : 0);
      }
    }
  }
  int width() const { return width_; }
  int height() const { return height_; }
  bool Fired(int x, int y) const {
    return counts_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)] > limit_;
  }
  int InRow(int y, int left, int right) const {
    return along_row_[At(right + 1, y)] - along_row_[At(left, y)];
  }
  int InColumn(int x, int top, int bottom) const {
    return along_column_[At(x, bottom + 1)] - along_column_[At(x, top)];
  }
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
  static std::uint32_t Limit(const std::vector<std::uint32_t>& counts) {
    std::vector<std::uint32_t> fired;
    for (const std::uint32_t n : counts)
      if (n > 0) fired.push_back(n);
    if (fired.empty()) return 0;
    const auto middle = fired.begin() + static_cast<std::ptrdiff_t>(fired.size() / 2);
    std::nth_element(fired.begin(), middle, fired.end());
    return static_cast<std::uint32_t>(kStray * *middle);
  }
  std::size_t At(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x);
  }

  int width_, height_;
  std::uint32_t limit_;  // events of a pixel that counts as silent
  const std::vector<std::uint32_t>& counts_;
  std::vector<int> along_row_, along_column_;  // pixels that fired, before each
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

// Pixels that fired along one edge of an area, some pixels outside of it.
struct Beside {
  int n = 0, fired = 0;
  double Share() const { return n > 0 ? static_cast<double>(fired) / n : 0; }
};

enum class Edge { kLeft, kRight, kTop, kBottom };

Beside CountBeside(const FiredPixels& pixels, const DeadArea& area, Edge edge, int away) {
  const bool column = edge == Edge::kLeft || edge == Edge::kRight;
  const int at = edge == Edge::kLeft    ? area.left - away
                 : edge == Edge::kRight ? area.right + away
                 : edge == Edge::kTop   ? area.top - away
                                        : area.bottom + away;
  if (at < 0 || at >= (column ? pixels.width() : pixels.height())) return {};
  return column ? Beside{area.height(), pixels.InColumn(at, area.top, area.bottom)}
                : Beside{area.width(), pixels.InRow(at, area.left, area.right)};
}

// Whether along each edge about as many pixels fire as further out; fills in the counts. Where a scene is
// plain, what fires touches the largest rectangle within here and there only.
bool LookBeside(const FiredPixels& pixels, DeadArea* area) {
  for (const Edge edge : {Edge::kLeft, Edge::kRight, Edge::kTop, Edge::kBottom}) {
    const Beside near = CountBeside(pixels, *area, edge, 1);
    if (near.n == 0) continue;  // the sensor's own edge
    Beside further;
    for (int away = 2; away <= kFurther; ++away) {
      const Beside line = CountBeside(pixels, *area, edge, away);
      further.n += line.n, further.fired += line.fired;
    }
    if (near.Share() < std::max(kLeastFired, kAlike * further.Share())) return false;
    area->beside += near.n, area->beside_fired += near.fired;
  }
  return area->beside > 0;
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
        if (size <= largest || (y + 1 < height && pixels.InRow(y + 1, area.left, area.right) == 0)) continue;
        if (!LookBeside(pixels, &area)) continue;
        area.usual = usual;
        area.chance = Chance(area.beside_fired / kTogether, area.beside / kTogether, usual);
        if (area.chance > kRareness) continue;
        largest = size;
        best = area;
      }
      if (now > 0 && (open.empty() || open.back().second < now)) open.emplace_back(begin, now);
    }
  }
  return best;
}

}  // namespace evit::diagnosis
