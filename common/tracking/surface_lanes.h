#pragma once

#include <cstdint>
#include <cstring>

#include "common/geometry/lane_camera.h"

/// Samples of a SurfaceField's B-spline, a block of lanes at a time.
namespace evit {

/// One level of a field.
struct LaneField {
  const std::uint8_t* data;
  int step;            // bytes from row to row
  float scale;         // pixels of this level per pixel of level 0
  float max_x, max_y;  // farthest places whose neighbours can be read
};

struct FieldLanes {
  alignas(64) float value[kLanes];
  alignas(64) float gx[kLanes], gy[kLanes];                 // per pixel of level 0
  alignas(64) float hxx[kLanes], hxy[kLanes], hyy[kLanes];  // per squared pixel
};

/// At (u, v), pixels of level 0, finite. Outside the image the nearest border value counts, with no gradient
/// across. Without derivatives `value` alone is written.
template <bool kDerivatives>
EVIT_ALWAYS_INLINE void SampleLanes(const LaneField& field, const float* u, const float* v, FieldLanes* out) {
  alignas(64) float a[kLanes], b[kLanes], across_x[kLanes], across_y[kLanes];
  alignas(64) std::int32_t offset[kLanes];
  alignas(64) std::uint32_t row[3][kLanes];
  for (int l = 0; l < kLanes; ++l) {
    const float x = u[l] * field.scale, y = v[l] * field.scale;
    const float low_x = x > 1 ? x : 1, low_y = y > 1 ? y : 1;
    const float cx = low_x < field.max_x ? low_x : field.max_x;
    const float cy = low_y < field.max_y ? low_y : field.max_y;
    const auto i =
        static_cast<int>(cx + 0.5F);  // NOLINT(bugprone-incorrect-roundings): positive, and lround is slow
    const auto j = static_cast<int>(cy + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
    a[l] = cx - static_cast<float>(i);
    b[l] = cy - static_cast<float>(j);
    across_x[l] = cx == x ? 1 : 0;
    across_y[l] = cy == y ? 1 : 0;
    offset[l] = (j - 1) * field.step + (i - 1);
  }
  for (int l = 0; l < kLanes; ++l) {  // three taps in each row, read as four bytes
    const std::uint8_t* const corner = field.data + offset[l];
    std::memcpy(&row[0][l], corner, 4);
    std::memcpy(&row[1][l], corner + field.step, 4);
    std::memcpy(&row[2][l], corner + field.step + field.step, 4);
  }
  for (int l = 0; l < kLanes; ++l) {
    // Weights of the three taps around a place a from the middle one; their derivatives below.
    const float ax = a[l], ay = b[l];
    const float x0 = 0.5F * (0.5F - ax) * (0.5F - ax), x1 = 0.75F - ax * ax;
    const float x2 = 0.5F * (0.5F + ax) * (0.5F + ax);
    const float y0 = 0.5F * (0.5F - ay) * (0.5F - ay), y1 = 0.75F - ay * ay;
    const float y2 = 0.5F * (0.5F + ay) * (0.5F + ay);
    float value[3], slope[3], curve[3];
    for (int r = 0; r < 3; ++r) {
      const std::uint32_t bytes = row[r][l];
      const auto t0 = static_cast<float>(static_cast<std::int32_t>(bytes & 255U));
      const auto t1 = static_cast<float>(static_cast<std::int32_t>((bytes >> 8) & 255U));
      const auto t2 = static_cast<float>(static_cast<std::int32_t>((bytes >> 16) & 255U));
      value[r] = x0 * t0 + x1 * t1 + x2 * t2;
      if (kDerivatives) {
        slope[r] = (ax - 0.5F) * t0 - 2 * ax * t1 + (ax + 0.5F) * t2;
        curve[r] = t0 - 2 * t1 + t2;
      }
    }
    out->value[l] = y0 * value[0] + y1 * value[1] + y2 * value[2];
    if (kDerivatives) {
      const float dy0 = ay - 0.5F, dy1 = -2 * ay, dy2 = ay + 0.5F;
      const float k1 = field.scale, k2 = k1 * k1, in_x = across_x[l], in_y = across_y[l];
      out->gx[l] = in_x * k1 * (y0 * slope[0] + y1 * slope[1] + y2 * slope[2]);
      out->gy[l] = in_y * k1 * (dy0 * value[0] + dy1 * value[1] + dy2 * value[2]);
      out->hxx[l] = in_x * k2 * (y0 * curve[0] + y1 * curve[1] + y2 * curve[2]);
      out->hxy[l] = in_x * in_y * k2 * (dy0 * slope[0] + dy1 * slope[1] + dy2 * slope[2]);
      out->hyy[l] = in_y * k2 * (value[0] - 2 * value[1] + value[2]);
    }
  }
}

}  // namespace evit
