#include "common/events/active_event_surface.h"

#include <algorithm>
#include <stdexcept>

namespace evit {
namespace {

// Stamps stay below this: age and look-ahead differences never overflow 32 bits.
constexpr Utime kMaxRelative = 1'000'000'000;

}  // namespace

ActiveEventSurface::ActiveEventSurface(int width, int height) : width_(width), height_(height) {
  if (width <= 0 || height <= 0) throw std::invalid_argument("surface of active events: empty image");
  stamps_.assign(std::size_t(width) * height, kNever);
}

void ActiveEventSurface::Clear() {
  std::fill(stamps_.begin(), stamps_.end(), kNever);
  has_base_ = false;
}

void ActiveEventSurface::MoveBase(Utime t) {
  if (!has_base_) {
    base_ = t;
    has_base_ = true;
    return;
  }
  const Utime shift = t - base_;
  for (std::int32_t& stamp : stamps_) {
    stamp = static_cast<std::int32_t>(std::max<Utime>(stamp - shift, kNever));
  }
  base_ = t;
}

std::int32_t ActiveEventSurface::Relative(Utime t) const {
  return static_cast<std::int32_t>(std::clamp<Utime>(t - base_, 0, kMaxRelative + 100'000'000));
}

void ActiveEventSurface::Update(const Utime* t, const std::uint16_t* x, const std::uint16_t* y,
                                std::size_t n) {
  for (std::size_t begin = 0; begin < n;) {
    if (!has_base_ || t[begin] - base_ >= kMaxRelative) MoveBase(t[begin]);
    const std::size_t end =
        t[n - 1] - base_ < kMaxRelative ? n : std::lower_bound(t + begin, t + n, base_ + kMaxRelative) - t;
    UpdateWithinBase(t + begin, x + begin, y + begin, end - begin);
    begin = end;
  }
}

void ActiveEventSurface::UpdateWithinBase(const Utime* t, const std::uint16_t* x, const std::uint16_t* y,
                                          std::size_t n) {
  const auto width = static_cast<unsigned>(width_), height = static_cast<unsigned>(height_);
  const Utime base = base_;
  std::int32_t* const stamps = stamps_.data();
  std::int64_t outside = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (x[i] >= width || y[i] >= height) {
      ++outside;
      continue;
    }
    stamps[y[i] * width + x[i]] = static_cast<std::int32_t>(t[i] - base);
  }
  outside_ += outside;
}

}  // namespace evit
