#pragma once

#include <optional>
#include <utility>

namespace evit {

/// Width and height of sensors that are or were sold, the smallest first: DVS128, DAVIS240, ATIS, GenX320,
/// DAVIS346, Gen3 VGA and DVXplorer, Gen4 HD.
inline constexpr std::pair<int, int> kKnownSensors[] = {{128, 128}, {240, 180}, {304, 240}, {320, 320},
                                                        {346, 260}, {640, 480}, {1280, 720}};

/// The smallest of them that holds so many columns and rows; nothing where none does.
inline std::optional<std::pair<int, int>> SmallestKnownSensor(int columns, int rows) {
  for (const auto& [width, height] : kKnownSensors) {
    if (columns <= width && rows <= height) return std::pair(width, height);
  }
  return {};
}

}  // namespace evit
