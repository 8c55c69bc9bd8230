#include "tools/formats/event_packet/clock_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace evit::formats {
namespace {

constexpr std::size_t kLineFrom = 10;  // seconds with data
constexpr double kMaxDrift = 1e-3;     // no two quartz clocks differ by so much: then it is something else

}  // namespace

void ClockFit::Add(Utime sensor, Utime host) {
  const Utime second = sensor / kMicrosPerSecond, offset = host - sensor;
  const auto [at, is_new] = offsets_.emplace(second, offset);
  if (!is_new) at->second = std::min(at->second, offset);
}

// The median of the slopes between points half the recording apart (Theil and Sen's, on some pairs), then of
// the offsets: single late seconds do not matter.
void ClockFit::Solve() {
  slope_ = 0;
  offset_ = 0;
  if (offsets_.empty()) return;
  const std::vector<std::pair<Utime, Utime>> points(offsets_.begin(), offsets_.end());
  origin_ = points.front().first * kMicrosPerSecond;
  if (points.size() > kLineFrom) {
    std::vector<double> slopes;
    const std::size_t half = points.size() / 2;
    for (std::size_t k = 0; k + half < points.size(); ++k) {
      slopes.push_back(static_cast<double>(points[k + half].second - points[k].second) /
                       (1e6 * static_cast<double>(points[k + half].first - points[k].first)));
    }
    std::nth_element(slopes.begin(), slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2),
                     slopes.end());
    const double slope = slopes[slopes.size() / 2];
    if (std::abs(slope) < kMaxDrift) slope_ = slope;
  }
  std::vector<Utime> rest;
  rest.reserve(points.size());
  for (const auto& [second, offset] : points)
    rest.push_back(offset - std::llround(slope_ * static_cast<double>(second * kMicrosPerSecond - origin_)));
  if (points.size() <= kLineFrom) {
    offset_ = *std::min_element(rest.begin(), rest.end());
  } else {
    std::nth_element(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2), rest.end());
    offset_ = rest[rest.size() / 2];
  }
}

Utime ClockFit::ToHost(Utime sensor) const {
  return sensor + offset_ + std::llround(slope_ * static_cast<double>(sensor - origin_));
}

}  // namespace evit::formats
