#include "common/map/photometric_map.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "common/files/whole_file.h"
#include "common/map/map_formats.h"

namespace evit {
namespace {

constexpr char kRemedy[] = "; make one with `evit map photometric`";

}  // namespace

PhotometricMap LoadPhotometricMap(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream stream;
  if (!file || !(stream << file.rdbuf())) {
    throw std::runtime_error(path + ": cannot be read, or is empty; expected a PLY with intensities" +
                             kRemedy);
  }
  const std::string bytes = stream.str();
  if (!IsPly(bytes)) {
    throw std::runtime_error(path + ": is not a PLY; expected a photometric map" + kRemedy);
  }
  CloudPoints points;
  std::vector<float> intensities;
  PhotometricMap map;
  std::string format;
  try {
    ReadPly(bytes, &points, &format, &intensities);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  if (intensities.size() != points.size()) {
    throw std::runtime_error(path +
                             ": its vertices have no property intensity: a map for photometric "
                             "tracking needs it" +
                             kRemedy);
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const float intensity = intensities[k];
    const Eigen::Vector3f point = points[k].cast<float>();
    if (!point.allFinite() || !std::isfinite(intensity)) continue;
    if (intensity < 0 || intensity > 1) {
      throw std::runtime_error(path + ": vertex " + std::to_string(k) + ": intensity is not 0..1" + kRemedy);
    }
    map.points.push_back(point);
    map.intensities.push_back(intensity);
  }
  if (map.points.empty()) throw std::runtime_error(path + ": the map is empty" + kRemedy);
  return map;
}

void WritePhotometricMap(const std::string& path, const PhotometricMap& map) {
  WholeFile whole(path);
  std::ofstream& file = whole.stream();
  file << "ply\nformat binary_little_endian 1.0\ncomment photometric map of evit: metres, z up\nelement "
          "vertex "
       << map.points.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nend_header\n";
  std::vector<float> rows;
  rows.reserve(4 * map.points.size());
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    const Eigen::Vector3f& p = map.points[k];
    rows.insert(rows.end(), {p.x(), p.y(), p.z(), map.intensities[k]});
  }
  file.write(reinterpret_cast<const char*>(rows.data()),
             static_cast<std::streamsize>(rows.size() * sizeof(float)));
  whole.Commit();
}

}  // namespace evit
