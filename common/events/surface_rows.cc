#include "common/events/surface_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/simd/lanes.h"

namespace evit {
namespace {

EVIT_MULTIVERSION void Quantize(const std::int32_t* __restrict stamps, std::size_t n, std::int32_t now,
                                int shift, std::uint16_t* __restrict out) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::int32_t d = (now - stamps[i]) >> shift;
    out[i] = static_cast<std::uint16_t>(d < 65535 ? d : 65535);
  }
}

EVIT_MULTIVERSION void NearRow(const std::uint16_t* __restrict d, int n, std::uint16_t limit,
                               std::uint8_t* __restrict out) {
  for (int x = 0; x < n; ++x) out[x] = d[x] <= limit ? 255 : 0;
}

// Rows have a pixel more on each side. out: 255 where a neighbour is near.
EVIT_MULTIVERSION void SupportRow(const std::uint8_t* __restrict above, const std::uint8_t* __restrict here,
                                  const std::uint8_t* __restrict below, int n,
                                  std::uint8_t* __restrict column, std::uint8_t* __restrict out) {
  for (int x = 0; x < n + 2; ++x) column[x] = above[x] | here[x] | below[x];
  for (int x = 0; x < n; ++x) out[x] = column[x] | column[x + 2] | above[x + 1] | below[x + 1];
}

// What cannot be seen, be it too far in time or unsupported, becomes `unseen`, one unit beyond the last
// visible.
EVIT_MULTIVERSION void VisibleRow(const std::uint16_t* __restrict d, const std::uint8_t* __restrict supported,
                                  int n, std::uint16_t unseen, std::uint16_t* __restrict out) {
  for (int x = 0; x < n; ++x) {
    const std::uint16_t limited = d[x] < unseen ? d[x] : unseen;
    out[x] = supported[x] != 0 ? limited : unseen;
  }
}

// The decay, Eq. (2) of the paper (plainly in reference_surface.cc), in 1/128 grey levels: (255 * 128)^(1/8)
// e^(-rate d / 8) as a polynomial in d, to the eighth power.
EVIT_ALWAYS_INLINE float DecayAt(float d, const float* c) {
  const float root = c[0] + d * (c[1] + d * (c[2] + d * (c[3] + d * c[4])));
  const float squared = root * root, fourth = squared * squared;
  return fourth * fourth;
}

EVIT_MULTIVERSION void DecayRow(const std::uint16_t* __restrict d, int n, const float* c, float least,
                                std::uint16_t* __restrict out) {
  for (int x = 0; x < n; ++x) {
    const float v = DecayAt(static_cast<float>(d[x]), c);
    out[x] = static_cast<std::uint16_t>(static_cast<std::int32_t>(v > least ? v + 0.5F : 0.0F));
  }
}

EVIT_ALWAYS_INLINE std::uint16_t Scaled(std::uint16_t value, std::uint16_t weight) {
  return static_cast<std::uint16_t>((static_cast<std::uint32_t>(value) * weight) >> 16);
}
EVIT_ALWAYS_INLINE std::uint16_t Pair(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>(a + b);  // at most 2 * 255 * 128: no overflow
}

// Symmetric convolution of n values, centre and w[k] (of 65536) at distance k: the default's radius written
// out.
EVIT_ALWAYS_INLINE void Convolve3(const std::uint16_t* const* rows, int n, const std::uint16_t* w,
                                  std::uint16_t* __restrict out) {
  const std::uint16_t *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3];
  const std::uint16_t *e = rows[4], *f = rows[5], *g = rows[6];
  const std::uint16_t w0 = w[0], w1 = w[1], w2 = w[2], w3 = w[3];
  for (int x = 0; x < n; ++x) {
    const std::uint16_t inner = Pair(Scaled(d[x], w0), Scaled(Pair(c[x], e[x]), w1));
    const std::uint16_t outer = Pair(Scaled(Pair(b[x], f[x]), w2), Scaled(Pair(a[x], g[x]), w3));
    out[x] = Pair(inner, outer);
  }
}

EVIT_MULTIVERSION void Convolve(const std::uint16_t* const* rows, int radius, int n, const std::uint16_t* w,
                                std::uint16_t* out) {
  if (radius == 3) {
    Convolve3(rows, n, w, out);
    return;
  }
  const std::uint16_t* const middle = rows[radius];
  if (radius == 0) {
    std::copy_n(middle, n, out);
    return;
  }
  for (int x = 0; x < n; ++x) out[x] = Scaled(middle[x], w[0]);
  for (int k = 1; k <= radius; ++k) {
    const std::uint16_t *before = rows[radius - k], *after = rows[radius + k];
    for (int x = 0; x < n; ++x) out[x] = Pair(out[x], Scaled(Pair(before[x], after[x]), w[k]));
  }
}

EVIT_MULTIVERSION void NegateRow(const std::uint16_t* __restrict in, int n, std::uint8_t* __restrict out) {
  for (int x = 0; x < n; ++x) {
    const auto value = static_cast<std::uint16_t>((in[x] + 64) >> 7);
    out[x] = static_cast<std::uint8_t>(255 - value);
  }
}

}  // namespace

void QuantizeDistances(const std::int32_t* stamps, std::size_t n, std::int32_t now, int shift,
                       std::uint16_t* out) {
  Quantize(stamps, n, now, shift, out);
}

SurfacePass::SurfacePass(int width, int height, double sigma)
    : width_(width), height_(height), radius_(sigma > 0 ? static_cast<int>(std::lround(6 * sigma)) / 2 : 0) {
  radius_ = std::min({radius_, width - 1, height - 1});
  std::vector<double> gauss;
  double sum = 0;
  for (int k = 0; k <= radius_; ++k) {
    gauss.push_back(k == 0 ? 1 : std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += k == 0 ? 1 : 2 * gauss.back();
  }
  for (const double g : gauss) weights_.push_back(static_cast<std::uint16_t>(std::lround(65536 * g / sum)));
  stride_ = static_cast<std::size_t>(width);
  near_.assign(3 * (stride_ + 2), 0);
  column_.resize(stride_ + 2);
  supported_.assign(stride_, 255);
  visible_.resize(stride_);
  padded_.resize(stride_ + 2 * static_cast<std::size_t>(radius_));
  sum_.resize(stride_);
  ring_.resize(stride_ * (2 * static_cast<std::size_t>(radius_) + 1));
}

void SurfacePass::DrawRow(const std::uint16_t* distances, int y, const Decay& decay) {
  const auto near_row = [&](int row) {
    return near_.data() + static_cast<std::size_t>(row % 3) * (stride_ + 2);
  };
  const auto fill = [&](int row) {
    std::uint8_t* const to = near_row(row + 3) + 1;
    if (row < 0 || row >= height_) {
      std::fill_n(to, stride_, std::uint8_t{0});
    } else {
      NearRow(distances + static_cast<std::size_t>(row) * stride_, width_, decay.near_distance, to);
    }
  };
  if (decay.support) {
    if (y == 0) fill(-1), fill(0);
    fill(y + 1);
    SupportRow(near_row(y + 2), near_row(y + 3), near_row(y + 4), width_, column_.data(), supported_.data());
  }
  std::uint16_t* const row = padded_.data() + radius_;
  const auto unseen = static_cast<std::uint16_t>(decay.max_distance + 1);
  VisibleRow(distances + static_cast<std::size_t>(y) * stride_, supported_.data(), width_, unseen,
             visible_.data());
  DecayRow(visible_.data(), width_, coefficients_, least_, row);
  for (int k = 1; k <= radius_; ++k) {
    row[-k] = row[k];
    row[width_ - 1 + k] = row[width_ - 1 - k];
  }
}

void SurfacePass::Run(const std::uint16_t* distances, const Decay& decay, std::uint8_t* image) {
  // e^-u on [0, 0.8] by a polynomial of fourth degree (Chebyshev nodes; 7e-6), u = d / (8 decay).
  constexpr double kSeries[] = {0.99999615, -0.99975897, 0.49755438, -0.15782825, 0.02811673};
  double scale = std::pow(255.0 * 128.0, 0.125);
  for (int k = 0; k < 5; ++k, scale *= decay.rate / 8)
    coefficients_[k] = static_cast<float>(scale * kSeries[k]);
  least_ = DecayAt(static_cast<float>(decay.max_distance + 1), coefficients_);
  if (!decay.support) std::fill(supported_.begin(), supported_.end(), std::uint8_t{255});
  const int rows = 2 * radius_ + 1;
  std::vector<const std::uint16_t*> taps(static_cast<std::size_t>(rows));
  const auto ring_row = [&](int y) {
    const int reflected = y < 0 ? -y : y >= height_ ? 2 * height_ - 2 - y : y;
    return ring_.data() + static_cast<std::size_t>(reflected % rows) * stride_;
  };
  for (int y = 0; y < height_ + radius_; ++y) {
    if (y < height_) {
      DrawRow(distances, y, decay);
      for (int k = 0; k < rows; ++k) taps[k] = padded_.data() + k;
      Convolve(taps.data(), radius_, width_, weights_.data(), ring_row(y));
    }
    const int out = y - radius_;
    if (out < 0) continue;
    for (int k = 0; k < rows; ++k) taps[k] = ring_row(out - radius_ + k);
    Convolve(taps.data(), radius_, width_, weights_.data(), sum_.data());
    NegateRow(sum_.data(), width_, image + static_cast<std::size_t>(out) * stride_);
  }
}

}  // namespace evit
