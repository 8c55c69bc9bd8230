#include "common/map/map_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "common/files/table_reader.h"
#include "common/files/whole_file.h"
#include "common/map/map_attributes.h"
#include "common/map/map_formats.h"
#include "common/simd/lanes.h"
#include "common/text/words.h"

namespace evit {

namespace {

constexpr float kFarAway = 1e5;  // m: a float has steps of 8 mm there

}  // namespace

bool HeaderLine(const std::string& bytes, std::size_t* at, std::string* line) {
  const std::size_t first = bytes.find_first_of("\r\n");
  const bool cr = first != std::string::npos && bytes[first] == '\r' && bytes.compare(first, 2, "\r\n") != 0;
  const std::size_t end = bytes.find(cr ? '\r' : '\n', *at);
  if (end == std::string::npos) return false;
  *line = bytes.substr(*at, end - *at);
  *at = end + 1;
  return true;
}

namespace {

// Where x, y and z stand in a row: by the names of the columns, else first.
std::array<std::size_t, 3> AxesOf(const std::vector<std::string>& head) {
  std::array<std::size_t, 3> columns = {0, 1, 2};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto found = std::find_if(head.begin(), head.end(), [&](const std::string& name) {
      return LowerCase(name) == std::string(1, static_cast<char>('x' + axis));
    });
    if (found == head.end()) return {0, 1, 2};
    columns[axis] = static_cast<std::size_t>(found - head.begin());
  }
  return columns;
}

}  // namespace

void ReadXyz(const std::string& bytes, CloudPoints* points, std::string* format) {
  *format = "text";
  if (bytes.substr(0, 4096).find('\0') != std::string::npos)
    throw std::runtime_error("is neither a PCD nor a PLY nor text; convert it to one of them");
  TableReader rows(bytes, "line", "x y z");
  std::array<std::size_t, 3> columns{};
  while (rows.Next()) {
    if (points->empty()) {
      if (rows.line() == 1 && rows.WordsLeft() == 1) continue;  // the count in a PTS file
      columns = AxesOf(rows.head());
    }
    Eigen::Vector3d p;
    const std::size_t last = *std::max_element(columns.begin(), columns.end());
    for (std::size_t k = 0; k <= last; ++k) {
      const auto axis = std::find(columns.begin(), columns.end(), k);
      if (axis == columns.end()) {
        rows.Word();
      } else {
        p[axis - columns.begin()] = rows.Number();
      }
    }
    points->push_back(p);
  }
}

bool IsPly(const std::string& bytes) {
  const std::string head = LowerCase(bytes.substr(0, 4));
  return head == "ply\n" || head == "ply\r" || head == "ply ";
}

LoadedMap LoadMap(const std::string& path, const MapChange& change) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream stream;
  if (!file || !(stream << file.rdbuf())) {
    throw std::runtime_error(path + ": cannot be read, or is empty; expected a PCD, PLY or text point cloud");
  }
  std::string bytes = stream.str();
  stream.str("");
  if (bytes.rfind("\xEF\xBB\xBF", 0) == 0) bytes.erase(0, 3);  // byte order mark
  LoadedMap loaded;
  CloudPoints cloud;
  try {
    const std::string head = LowerCase(bytes.substr(0, 512));
    if (IsPly(bytes)) {
      ReadPly(bytes, &cloud, &loaded.format);
    } else if (head.find(".pcd") != std::string::npos || head.find("\nfields ") != std::string::npos ||
               head.rfind("fields ", 0) == 0 || head.find("\ncolumns ") != std::string::npos) {
      ReadPcd(bytes, &cloud, &loaded.format);
    } else {
      ReadXyz(bytes, &cloud, &loaded.format);
    }
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  auto& points = loaded.map.points;
  points.reserve(cloud.size());
  for (const Eigen::Vector3d& p : cloud) points.push_back((change.T * (change.scale * p)).cast<float>());
  const std::size_t before = points.size();
  loaded.map.attributes = ReadAttributes(bytes, before);
  for (PointAttributes& a : loaded.map.attributes) {
    a.direction = (change.T.q * a.direction.cast<double>()).cast<float>();
    a.sigma = static_cast<float>(change.scale * a.sigma);
  }
  KeepIf(&loaded.map, [&](std::size_t k) { return points[k].allFinite(); });
  loaded.n_dropped = before - points.size();
  if (points.empty()) {
    throw std::runtime_error(
        path + ": the map is empty" +
        (before > 0 ? " (none of its " + std::to_string(before) + " points is finite)" : "") +
        "; export it again with its points");
  }
  return loaded;
}

namespace {

void WriteWhole(const std::string& path, const std::string& bytes) {
  WholeFile whole(path);
  whole.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  whole.Commit();
}

}  // namespace

void WritePcd(const std::string& path, const PointMap& map) { WriteWhole(path, PcdBytes(map)); }

void WriteMap(const std::string& path, const PointMap& map) {
  const bool ply = path.size() > 4 && path.compare(path.size() - 4, 4, ".ply") == 0;
  WriteWhole(path, ply ? PlyBytes(map) : PcdBytes(map));
}

namespace {

// Squared distance of points[k] to its nearest neighbour, kLanes of them at a time. Requires another point.
EVIT_MULTIVERSION float NearestSquared(const std::vector<Eigen::Vector3f>& points, std::size_t k) {
  alignas(64) float best[kLanes];
  std::fill_n(best, kLanes, std::numeric_limits<float>::max());
  const float x = points[k].x(), y = points[k].y(), z = points[k].z();
  const auto search = [&](std::size_t begin, std::size_t end) {
    const float* const p = points.front().data();
    std::size_t j = begin;
    for (; j + kLanes <= end; j += kLanes) {
      for (int l = 0; l < kLanes; ++l) {
        const float* const q = p + 3 * (j + l);
        const float dx = q[0] - x, dy = q[1] - y, dz = q[2] - z;
        const float d2 = dx * dx + dy * dy + dz * dz;
        best[l] = d2 < best[l] ? d2 : best[l];
      }
    }
    for (; j < end; ++j) best[0] = std::min(best[0], (points[j] - points[k]).squaredNorm());
  };
  search(0, k);
  search(k + 1, points.size());
  return *std::min_element(best, best + kLanes);
}

}  // namespace

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
  // Nearest neighbours of some points among all: exact, and no index needed.
  constexpr std::size_t kSome = 100;
  std::vector<float> nearest;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kSome);
  for (std::size_t k = 0; k < points.size() && points.size() > 1; k += stride)
    nearest.push_back(NearestSquared(points, k));
  if (!nearest.empty()) {
    std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2),
                     nearest.end());
    summary.median_spacing = std::sqrt(nearest[nearest.size() / 2]);
  }
  return summary;
}

void RequireMetres(const MapSummary& summary, const std::string& path) {
  const float farthest = std::max(summary.min.cwiseAbs().maxCoeff(), summary.max.cwiseAbs().maxCoeff());
  const float typical = summary.median.cwiseAbs().maxCoeff();
  const std::string stem = std::filesystem::path(path).stem().string();
  if (typical > kFarAway) {
    char text[200], matrix[200];
    std::snprintf(
        text, sizeof text,
        ": coordinates up to %.0f m, where single precision has steps of %.2f m; move the map to where you "
        "are with ",
        farthest, std::nextafter(farthest, 2 * farthest) - farthest);
    std::snprintf(matrix, sizeof matrix, " --transform \"1 0 0 %.0f 0 1 0 %.0f 0 0 1 %.0f 0 0 0 1\" --out ",
                  -std::round(summary.median.x()), -std::round(summary.median.y()),
                  -std::round(summary.median.z()));
    throw std::runtime_error(path + text + "`evit map import " + path + matrix + stem + "_moved.pcd`");
  }
  const float extent = (summary.max - summary.min).maxCoeff();
  // Edges sampled more coarsely than a metre are not a semi-dense map; a few stray points far away do
  // not matter, so the spacing is what tells.
  if (summary.n_points < 100 || summary.median_spacing < 0.5) return;
  char text[200];
  std::snprintf(text, sizeof text,
                ": neighbouring points are %.1f m apart and the map is %.0f m wide: it looks like "
                "millimetres or centimetres, not metres; convert it with ",
                summary.median_spacing, extent);
  throw std::runtime_error(path + text + "`evit map import " + path + " --scale 0.001 --out " + stem +
                           "_metres.pcd` (0.01 for centimetres)");
}

}  // namespace evit
