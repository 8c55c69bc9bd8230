#include "common/map/map_attributes.h"

#include <array>
#include <cstring>

namespace evit {
namespace {

// As files name them, in the order of PointAttributes.
constexpr const char* kFields[] = {"direction_x", "direction_y", "direction_z", "sigma", "views", "contrast"};
constexpr std::size_t kColumns = 9;
using Row = std::array<float, kColumns>;

// Names of a row's columns, each between `before` and `behind`.
std::string Columns(bool attributed, const std::string& before, const std::string& behind) {
  std::string text;
  for (const char* axis : {"x", "y", "z"}) text += before + axis + behind;
  if (!attributed) return text;
  for (const char* name : kFields) text += before + name + behind;
  return text;
}

// The same word for each column.
std::string Each(bool attributed, const std::string& word) {
  std::string text;
  for (std::size_t k = 0; k < (attributed ? kColumns : 3); ++k) text += " " + word;
  return text;
}

std::string Rows(const PointMap& map) {
  std::string rows;
  const bool attributed = !map.attributes.empty();
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    const Eigen::Vector3f& p = map.points[k];
    Row row{p.x(), p.y(), p.z()};
    if (attributed) {
      const PointAttributes& a = map.attributes[k];
      row = {p.x(),           p.y(),   p.z(),   a.direction.x(), a.direction.y(),
             a.direction.z(), a.sigma, a.views, a.contrast};
    }
    rows.append(reinterpret_cast<const char*>(row.data()), (attributed ? kColumns : 3) * sizeof(float));
  }
  return rows;
}

}  // namespace

std::vector<PointAttributes> ReadAttributes(const std::string& bytes, std::size_t n) {
  std::vector<PointAttributes> attributes;
  const std::string head = bytes.substr(0, 2048);
  const std::string pcd_end = "\nDATA binary\n",
                    ply_end = Columns(true, "property float ", "\n") + "end_header\n";
  std::size_t at = std::string::npos;
  if (head.find("\nFIELDS" + Columns(true, " ", "") + "\nSIZE" + Each(true, "4") + "\nTYPE" +
                Each(true, "F") + "\n") != std::string::npos) {
    at = head.find(pcd_end);
    if (at != std::string::npos) at += pcd_end.size();
  } else if (head.rfind("ply\nformat binary_little_endian", 0) == 0) {
    at = head.find(ply_end);
    if (at != std::string::npos) at += ply_end.size();
  }
  if (at == std::string::npos || (bytes.size() - at) / sizeof(Row) < n) return attributes;
  attributes.reserve(n);
  for (std::size_t k = 0; k < n; ++k, at += sizeof(Row)) {
    Row row;
    std::memcpy(row.data(), bytes.data() + at, sizeof row);
    attributes.push_back({{row[3], row[4], row[5]}, row[6], row[7], row[8]});
  }
  return attributes;
}

std::string PcdBytes(const PointMap& map) {
  const bool attributed = !map.attributes.empty();
  const std::string n = std::to_string(map.points.size());
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS" + Columns(attributed, " ", "") +
         "\nSIZE" + Each(attributed, "4") + "\nTYPE" + Each(attributed, "F") + "\nCOUNT" +
         Each(attributed, "1") + "\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n +
         "\nDATA binary\n" + Rows(map);
}

std::string PlyBytes(const PointMap& map) {
  return "ply\nformat binary_little_endian 1.0\ncomment semi-dense map of evit: metres, z up\nelement "
         "vertex " +
         std::to_string(map.points.size()) + "\n" +
         Columns(!map.attributes.empty(), "property float ", "\n") + "end_header\n" + Rows(map);
}

}  // namespace evit
