#include "tools/mapping/map_edit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace evit::mapping {
namespace {

using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

Cell CellOf(const Eigen::Vector3f& p, double size) {
  const auto cell = [&](float v) { return static_cast<std::int64_t>(std::floor(v / size)); };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

float EndOf(const std::string& text, float open, bool* good) {
  if (text.find_first_not_of(" \t") == std::string::npos) return open;
  char* end = nullptr;
  const float value = std::strtof(text.c_str(), &end);
  *good = *good && end != text.c_str() && *end == '\0' && std::isfinite(value);
  return value;
}

}  // namespace

void Transform(const SE3& T, double scale, PointMap* map) {
  for (Eigen::Vector3f& p : map->points) p = (T * (scale * p.cast<double>())).cast<float>();
  for (PointAttributes& a : map->attributes) {
    a.direction = (T.q * a.direction.cast<double>()).cast<float>();
    a.sigma = static_cast<float>(scale * a.sigma);
  }
}

void Thin(double size, PointMap* map) {
  std::map<Cell, std::size_t> best;
  for (std::size_t k = 0; k < map->points.size(); ++k) {
    const auto [it, fresh] = best.emplace(CellOf(map->points[k], size), k);
    if (!fresh && !map->attributes.empty() && map->attributes[k].sigma < map->attributes[it->second].sigma)
      it->second = k;
  }
  std::vector<char> keep(map->points.size(), 0);
  for (const auto& [cell, k] : best) keep[k] = 1;
  KeepIf(map, [&](std::size_t k) { return keep[k] != 0; });
}

PointMap Merge(const std::vector<PointMap>& maps, double voxel) {
  PointMap merged;
  const bool attributed =
      std::all_of(maps.begin(), maps.end(), [](const PointMap& m) { return !m.attributes.empty(); });
  for (const PointMap& map : maps) {
    merged.points.insert(merged.points.end(), map.points.begin(), map.points.end());
    if (attributed)
      merged.attributes.insert(merged.attributes.end(), map.attributes.begin(), map.attributes.end());
  }
  if (voxel > 0) Thin(voxel, &merged);
  return merged;
}

CropBox ParseBox(const std::string& option, const std::string& text) {
  CropBox box;
  bool good = true;
  std::istringstream axes(text);
  std::string range;
  int axis = 0;
  for (; std::getline(axes, range, ','); ++axis) {
    const std::size_t colon = range.find(':');
    if (axis > 2 || colon == std::string::npos) break;
    box.min[axis] = EndOf(range.substr(0, colon), -std::numeric_limits<float>::infinity(), &good);
    box.max[axis] = EndOf(range.substr(colon + 1), std::numeric_limits<float>::infinity(), &good);
    good = good && box.min[axis] < box.max[axis];
  }
  if (!good || axis != 3 || !axes.eof()) {
    throw std::runtime_error(
        option + " \"" + text +
        "\": expected x0:x1,y0:y1,z0:z1 in m, the smaller first; an end left out is open, "
        "e.g. :,:,0.1:2");
  }
  return box;
}

void Crop(const CropBox& box, bool inverted, PointMap* map) {
  const std::vector<Eigen::Vector3f>& points = map->points;
  KeepIf(map, [&](std::size_t k) {
    const bool inside =
        (points[k].array() >= box.min.array()).all() && (points[k].array() <= box.max.array()).all();
    return inside != inverted;
  });
}

}  // namespace evit::mapping
