#include "common/tracking/surface_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace evit {

SurfaceField::SurfaceField(const cv::Mat& surface, int levels) {
  pyramid_.reserve(levels);
  pyramid_.push_back(surface.clone());
  for (int l = 1; l < levels; ++l) {
    cv::Mat half;
    cv::pyrDown(pyramid_.back(), half);  // its pixel (i, j) lies on (2i, 2j)
    pyramid_.push_back(half);
  }
  mean_ = cv::mean(surface)[0];
}

namespace {

using Vec = float __attribute__((vector_size(16)));  // one row of taps; the fourth weighs nothing
using Bytes = std::uint8_t __attribute__((vector_size(4)));

// Position in the image of one level: nearest pixel (i, j) with a neighbour on each side, and (a, b) in -0.5
// .. 0.5 from it.
struct Place {
  const std::uint8_t* corner;  // pixel (i - 1, j - 1)
  std::size_t step;
  float a, b, scale;
  bool inside_x, inside_y;
};

Place Locate(const cv::Mat& image, int level, double x, double y) {
  Place place{};
  const double scale = 1.0 / (1 << level), u = x * scale, v = y * scale;
  // Three columns are read as four bytes: one more must be there on the right.
  const double cu = std::clamp(u, 1.0, image.cols - 3.0), cv = std::clamp(v, 1.0, image.rows - 2.0);
  const int i = static_cast<int>(cu + 0.5), j = static_cast<int>(cv + 0.5);
  place.a = static_cast<float>(cu - i);
  place.b = static_cast<float>(cv - j);
  place.scale = static_cast<float>(scale);
  place.step = image.step;
  place.corner = image.data + (j - 1) * place.step + (i - 1);
  place.inside_x = cu == u;
  place.inside_y = cv == v;
  return place;
}

Vec Row(const std::uint8_t* data) {
  Bytes bytes;
  std::memcpy(&bytes, data, sizeof bytes);
  return __builtin_convertvector(bytes, Vec);
}

float Sum(Vec v) { return (v[0] + v[1]) + (v[2] + v[3]); }

// Quadratic B-spline weights of the three taps around a position a from the middle one, and their derivative.
struct Weights {
  float w0, w1, w2, d0, d1, d2;
  explicit Weights(float a)
      : w0(0.5f * (0.5f - a) * (0.5f - a)),
        w1(0.75f - a * a),
        w2(0.5f * (0.5f + a) * (0.5f + a)),
        d0(a - 0.5f),
        d1(-2.0f * a),
        d2(a + 0.5f) {}
};

}  // namespace

SurfaceField::Sample SurfaceField::At(int level, double x, double y) const {
  const Place place = Locate(pyramid_[level], level, x, y);
  const Weights wx(place.a), wy(place.b);
  const Vec r0 = Row(place.corner), r1 = Row(place.corner + place.step),
            r2 = Row(place.corner + 2 * place.step);
  const Vec value = wy.w0 * r0 + wy.w1 * r1 + wy.w2 * r2;
  const Vec down = wy.d0 * r0 + wy.d1 * r1 + wy.d2 * r2;
  const Vec curve = r0 - 2.0f * r1 + r2;
  const Vec w{wx.w0, wx.w1, wx.w2, 0}, d{wx.d0, wx.d1, wx.d2, 0}, dd{1, -2, 1, 0};
  const float k1 = place.scale, k2 = k1 * k1;
  Sample s{Sum(w * value),       k1 * Sum(d * value), k1 * Sum(w * down),
           k2 * Sum(dd * value), k2 * Sum(d * down),  k2 * Sum(w * curve)};
  if (!place.inside_x) s.gx = s.hxx = s.hxy = 0;
  if (!place.inside_y) s.gy = s.hyy = s.hxy = 0;
  return s;
}

float SurfaceField::ValueAt(int level, double x, double y) const {
  const Place place = Locate(pyramid_[level], level, x, y);
  const Weights wx(place.a), wy(place.b);
  const Vec value = wy.w0 * Row(place.corner) + wy.w1 * Row(place.corner + place.step) +
                    wy.w2 * Row(place.corner + 2 * place.step);
  return Sum(Vec{wx.w0, wx.w1, wx.w2, 0} * value);
}

}  // namespace evit
