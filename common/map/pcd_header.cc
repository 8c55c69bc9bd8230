#include "common/map/pcd_header.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "common/map/map_formats.h"
#include "common/text/words.h"

namespace evit {
namespace {

constexpr std::size_t kMaxStride = 1 << 20;  // bytes of one point, with all that comes along
constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 32;

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error(what); }

template <typename T, typename Member>
void Assign(std::istringstream& words, std::vector<PcdField>* fields, Member member, const char* key) {
  for (PcdField& field : *fields) {
    T value{};
    if (!(words >> value)) Fail(std::string(key) + " has fewer entries than FIELDS");
    field.*member = value;
  }
}

std::uint64_t Number(std::istringstream& words, const std::string& key) {
  std::uint64_t value = 0;
  if (!(words >> value)) Fail(key + ": expected a number");
  return value;
}

SE3 Viewpoint(std::istringstream& words) {
  double v[7];
  for (double& x : v) {
    if (!(words >> x)) Fail("VIEWPOINT: expected tx ty tz qw qx qy qz");
  }
  const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  const Eigen::Vector3d p(v[0], v[1], v[2]);
  if (!p.allFinite() || !(std::abs(q.norm() - 1) < 1e-2))
    Fail("VIEWPOINT: the quaternion qw qx qy qz is not of length 1");
  if (q.vec().isZero()) return {Eigen::Quaterniond::Identity(), p};
  return {q.normalized(), p};
}

// Offsets and length of the rows.
void LayOut(PcdHeader* header) {
  for (PcdField& field : header->fields) {
    if (field.size > 8 || field.count > 4096) Fail("field " + field.name + ": SIZE or COUNT is absurd");
    if (header->stride > kMaxStride) Fail("FIELDS, SIZE and COUNT make rows of absurd length");
    field.offset = header->stride;
    header->stride += field.size * field.count;
  }
}

}  // namespace

PcdHeader ReadPcdHeader(const std::string& bytes) {
  PcdHeader header;
  std::size_t at = 0;
  std::optional<std::uint64_t> width;
  std::uint64_t height = 1;
  while (header.data.empty()) {
    std::string line;
    if (!HeaderLine(bytes, &at, &line)) Fail("the PCD header has no DATA line");
    std::istringstream words(line);
    std::string key;
    if (!(words >> key) || key[0] == '#') continue;
    for (char& c : key) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (key == "FIELDS" || key == "COLUMNS") {
      for (std::string name; words >> name;) header.fields.push_back({LowerCase(name), 4, 1, 0, 'F'});
    } else if (key == "SIZE") {
      Assign<std::size_t>(words, &header.fields, &PcdField::size, "SIZE");
    } else if (key == "TYPE") {
      Assign<char>(words, &header.fields, &PcdField::type, "TYPE");
    } else if (key == "COUNT") {
      Assign<std::size_t>(words, &header.fields, &PcdField::count, "COUNT");
    } else if (key == "WIDTH") {
      width = Number(words, key);
    } else if (key == "HEIGHT") {
      height = Number(words, key);
    } else if (key == "POINTS") {
      header.points = Number(words, key);
    } else if (key == "VIEWPOINT") {
      header.viewpoint = Viewpoint(words);
    } else if (key == "DATA") {
      words >> header.data;
      header.data = LowerCase(header.data);
    }
  }
  header.end = at;
  // A product beyond all clouds says nothing: POINTS then counts.
  if (width && *width <= kMaxPoints && height <= kMaxPoints && (*width == 0 || height <= kMaxPoints / *width))
    header.cells = *width * height;
  LayOut(&header);
  return header;
}

std::size_t PcdHeader::Count(std::optional<std::uint64_t> rows) const {
  const auto checked = [](std::uint64_t n) {
    if (n > kMaxPoints) Fail("POINTS is absurd: " + std::to_string(n));
    return static_cast<std::size_t>(n);
  };
  if (!points && !cells) Fail("the PCD header has neither POINTS nor WIDTH and HEIGHT");
  if (!points || !cells || *points == *cells) return checked(points ? *points : *cells);
  for (const std::uint64_t n : {*points, *cells}) {
    if (rows && n == *rows) return checked(n);
  }
  Fail("POINTS is " + std::to_string(*points) + ", WIDTH x HEIGHT " + std::to_string(*cells) +
       ", and the data has " + (rows ? std::to_string(*rows) + " points" : std::string("another length")) +
       "; correct the header");
}

}  // namespace evit
