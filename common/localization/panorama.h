#pragma once

#include <cmath>
#include <cstdint>

#include "common/geometry/lane_camera.h"
#include "common/simd/lanes.h"

/// All directions around an upright viewer, as a picture: columns are azimuth (from x towards y), rows are
/// elevation (from straight down to straight up). A turn about the vertical moves it along its rows and
/// changes nothing else: that is why all yaws are compared at once.
namespace evit::panorama {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr int kColumns = 128;                // 2.8 degrees each
inline constexpr int kRows = 64;                    // 2.8 degrees each
inline constexpr int kDirections = 4;               // of an edge in the picture: 45 degrees each, of 180
inline constexpr double kBin = 2 * kPi / kColumns;  // rad, of both

/// One picture for each direction, and one of edges in whatever direction: all of them below each other.
inline constexpr int kAnyDirection = kDirections;
inline constexpr int kStackedRows = (kDirections + 1) * kRows;

/// Number of the place, row * kColumns + column, where a direction (x, y, z; any length but 0) lies. Without
/// branches, for loops over lanes.
EVIT_ALWAYS_INLINE int PlaceOf(float x, float y, float z) {
  const float flat = std::sqrt(x * x + y * y);
  const float ax = std::abs(x), ay = std::abs(y);
  float azimuth = LaneAtan(ay / (ax + 1e-12F));
  azimuth = x < 0 ? static_cast<float>(kPi) - azimuth : azimuth;
  azimuth = y < 0 ? -azimuth : azimuth;
  float elevation = LaneAtan(std::abs(z) / (flat + 1e-12F));
  elevation = z < 0 ? -elevation : elevation;
  constexpr auto kPerRad = static_cast<float>(1 / kBin);
  const int column = static_cast<int>((azimuth + static_cast<float>(kPi)) * kPerRad) & (kColumns - 1);
  int row = static_cast<int>((elevation + static_cast<float>(kPi / 2)) * kPerRad);
  row = row < kRows - 1 ? row : kRows - 1;
  return row * kColumns + column;
}

/// A line through that direction that goes along `d`, in the picture: its parts to the east and upwards.
struct PictureLine {
  float east, north;
};
EVIT_ALWAYS_INLINE PictureLine LineAt(float x, float y, float z, float dx, float dy, float dz) {
  const float flat = std::sqrt(x * x + y * y) + 1e-9F, length = std::sqrt(flat * flat + z * z);
  return {(-y * dx + x * dy) / flat, (-z * (x * dx + y * dy) / flat + flat * dz) / length};
}

/// The direction's picture. They are centred on 0, 45, 90 and 135 degrees: most edges of a room are level or
/// upright.
EVIT_ALWAYS_INLINE int DirectionBin(const PictureLine& line) {
  constexpr float kTan = 0.41421356F;  // of 22.5 degrees
  const float east = std::abs(line.east), north = std::abs(line.north);
  const int slanting = line.east * line.north > 0 ? 1 : 3;
  const int steep = east < kTan * north ? 2 : slanting;
  return north < kTan * east ? 0 : steep;
}

}  // namespace evit::panorama
