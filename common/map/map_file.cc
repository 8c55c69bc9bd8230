#include "common/map/map_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "common/files/whole_file.h"
#include "common/map/map_formats.h"

namespace evit {

bool ParseThree(const std::string& line, float* xyz) {
  const char* at = line.c_str();
  for (int k = 0; k < 3; ++k) {
    while (*at == ' ' || *at == '\t' || *at == ',' || *at == ';') ++at;
    char* end = nullptr;
    xyz[k] = std::strtof(at, &end);
    if (end == at) return false;
    at = end;
  }
  return true;
}

void ReadXyz(const std::string& bytes, std::vector<Eigen::Vector3f>* points, std::string* format) {
  *format = "text";
  std::istringstream lines(bytes);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    Eigen::Vector3f p;
    if (!ParseThree(line, p.data())) {
      if (points->empty() && std::isalpha(static_cast<unsigned char>(line[first])) != 0)
        continue;  // column names
      throw std::runtime_error("line " + std::to_string(number) + ": expected three numbers x y z");
    }
    points->push_back(p);
  }
}

LoadedMap LoadMap(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream stream;
  if (!file || !(stream << file.rdbuf())) {
    throw std::runtime_error(path + ": cannot be read, or is empty; expected a PCD, PLY or text point cloud");
  }
  const std::string bytes = stream.str();
  LoadedMap loaded;
  auto& points = loaded.map.points;
  try {
    const std::string head = bytes.substr(0, 512);
    if (head.rfind("ply", 0) == 0) {
      ReadPly(bytes, &points, &loaded.format);
    } else if (head.find("FIELDS") != std::string::npos || head.find(".PCD") != std::string::npos) {
      ReadPcd(bytes, &points, &loaded.format);
    } else {
      ReadXyz(bytes, &points, &loaded.format);
    }
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  const std::size_t before = points.size();
  points.erase(std::remove_if(points.begin(), points.end(), [](const auto& p) { return !p.allFinite(); }),
               points.end());
  loaded.n_dropped = before - points.size();
  if (points.empty()) {
    throw std::runtime_error(
        path + ": the map is empty" +
        (before > 0 ? " (none of its " + std::to_string(before) + " points is finite)" : "") +
        "; export it again with its points");
  }
  return loaded;
}

void WritePcd(const std::string& path, const PointMap& map) {
  const std::string n = std::to_string(map.points.size());
  WholeFile whole(path);
  std::ofstream& file = whole.stream();
  file << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F "
          "F\nCOUNT 1 1 1\n"
       << "WIDTH " << n << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << n << "\nDATA binary\n";
  file.write(reinterpret_cast<const char*>(map.points.data()),
             static_cast<std::streamsize>(map.points.size() * sizeof(Eigen::Vector3f)));
  whole.Commit();
}

MapSummary Summarize(const PointMap& map) {
  const auto& points = map.points;
  MapSummary summary;
  summary.n_points = points.size();
  summary.min = summary.max = points.front();
  for (const auto& p : points) {
    summary.min = summary.min.cwiseMin(p);
    summary.max = summary.max.cwiseMax(p);
  }
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    values.reserve(points.size());
    for (const auto& p : points) values.push_back(p[axis]);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    summary.median[axis] = values[values.size() / 2];
  }
  // Nearest neighbours of some 200 points among all: exact, and no index needed.
  std::vector<float> nearest;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 200);
  for (std::size_t k = 0; k < points.size() && points.size() > 1; k += stride) {
    float best = std::numeric_limits<float>::max();
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (j != k) best = std::min(best, (points[j] - points[k]).squaredNorm());
    }
    nearest.push_back(best);
  }
  if (!nearest.empty()) {
    std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2),
                     nearest.end());
    summary.median_spacing = std::sqrt(nearest[nearest.size() / 2]);
  }
  return summary;
}

void RequireMetres(const MapSummary& summary, const std::string& path) {
  const float extent = (summary.max - summary.min).maxCoeff();
  // Edges sampled more coarsely than a metre are no semi-dense map; a few stray points far away are no
  // reason, so the spacing is what tells.
  if (summary.n_points < 100 || summary.median_spacing < 0.5) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      ": neighbouring points are %.1f m apart and the map is %.0f m wide: it looks like millimetres, not "
      "metres; convert it with `evit map import --scale 0.001`",
      summary.median_spacing, extent);
  throw std::runtime_error(path + text);
}

}  // namespace evit
