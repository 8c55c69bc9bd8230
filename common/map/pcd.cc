#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "common/map/map_formats.h"

namespace evit {
namespace {

constexpr std::size_t kMaxStride = 1 << 20;  // bytes of one point, with all that comes along

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error(what); }

struct Field {
  std::string name;
  std::size_t size = 4, count = 1, offset = 0;
  char type = 'F';
};

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0, stride = 0, end = 0;  // end: first byte of the data
  std::string data;
};

template <typename T, typename Member>
void Assign(std::istringstream& words, std::vector<Field>* fields, Member member, const char* key) {
  for (Field& field : *fields) {
    T value{};
    if (!(words >> value)) Fail(std::string(key) + " has fewer entries than FIELDS");
    field.*member = value;
  }
}

Header ReadHeader(const std::string& bytes) {
  Header header;
  std::size_t at = 0;
  bool has_points = false;
  std::size_t width = 0, height = 1;
  for (int line_number = 1; header.data.empty(); ++line_number) {
    const std::size_t newline = bytes.find('\n', at);
    if (newline == std::string::npos) Fail("the PCD header has no DATA line");
    std::istringstream words(bytes.substr(at, newline - at));
    at = newline + 1;
    std::string key;
    if (!(words >> key) || key[0] == '#') continue;
    if (key == "FIELDS") {
      for (std::string name; words >> name;) header.fields.push_back({name, 4, 1, 0, 'F'});
    } else if (key == "SIZE") {
      Assign<std::size_t>(words, &header.fields, &Field::size, "SIZE");
    } else if (key == "TYPE") {
      Assign<char>(words, &header.fields, &Field::type, "TYPE");
    } else if (key == "COUNT") {
      Assign<std::size_t>(words, &header.fields, &Field::count, "COUNT");
    } else if (key == "WIDTH") {
      words >> width;
    } else if (key == "HEIGHT") {
      words >> height;
    } else if (key == "POINTS") {
      has_points = static_cast<bool>(words >> header.points);
    } else if (key == "DATA") {
      words >> header.data;
    }
  }
  header.end = at;
  if (!has_points) header.points = width * height;
  for (Field& field : header.fields) {
    if (field.size > 8 || field.count > 4096) Fail("field " + field.name + ": SIZE or COUNT is absurd");
    if (header.stride > kMaxStride) Fail("FIELDS, SIZE and COUNT make rows of absurd length");
    field.offset = header.stride;
    header.stride += field.size * field.count;
  }
  if (header.points > (std::size_t{1} << 32)) Fail("POINTS is absurd: " + std::to_string(header.points));
  return header;
}

const Field& Find(const Header& header, const char* name) {
  const auto it = std::find_if(header.fields.begin(), header.fields.end(),
                               [&](const Field& f) { return f.name == name; });
  if (it == header.fields.end()) Fail(std::string("FIELDS has no ") + name);
  if (it->type != 'F' || (it->size != 4 && it->size != 8))
    Fail(std::string("field ") + name + " is not float or double");
  if (it->count != 1) Fail(std::string("field ") + name + " has a COUNT other than 1");
  return *it;
}

float Load(const char* data, const Field& field) {
  if (field.size == 8) {
    double v = 0;
    std::memcpy(&v, data, 8);
    return static_cast<float>(v);
  }
  float v = 0;
  std::memcpy(&v, data, 4);
  return v;
}

void ReadAscii(const Header& header, const std::string& bytes, std::vector<Eigen::Vector3f>* points) {
  std::size_t columns[3], column = 0;
  for (const Field& field : header.fields) {
    for (int k = 0; k < 3; ++k) {
      if (field.name == std::string(1, static_cast<char>('x' + k))) columns[k] = column;
    }
    column += field.count;
  }
  std::istringstream lines(bytes.substr(header.end));
  std::string line;
  while (points->size() < header.points && std::getline(lines, line)) {
    std::istringstream words(line);
    Eigen::Vector3f p;
    std::string word;
    std::size_t found = 0;
    for (std::size_t k = 0; words >> word; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        if (k != columns[axis]) continue;
        char* end = nullptr;
        p[axis] = std::strtof(word.c_str(), &end);
        if (*end != '\0') Fail("point " + std::to_string(points->size()) + ": \"" + word + "\" is no number");
        ++found;
      }
    }
    if (found == 0) continue;  // an empty line
    if (found < 3)
      Fail("point " + std::to_string(points->size()) + " has fewer than " + std::to_string(column) +
           " values");
    points->push_back(p);
  }
}

}  // namespace

void ReadPcd(const std::string& bytes, std::vector<Eigen::Vector3f>* points, std::string* format) {
  const Header header = ReadHeader(bytes);
  const Field* axes[3] = {&Find(header, "x"), &Find(header, "y"), &Find(header, "z")};
  *format = "PCD " + header.data;
  const std::size_t n = header.points, available = bytes.size() - header.end;
  const auto truncated = [&](std::size_t needed) {
    Fail("truncated: " + std::to_string(n) + " points need " + std::to_string(needed) + " bytes of data, " +
         std::to_string(available) + " are there; copy the file again");
  };
  if (header.data == "ascii") {
    if (n > available) truncated(n * 6);
    points->reserve(n);
    ReadAscii(header, bytes, points);
    if (points->size() < n) {
      Fail("truncated: " + std::to_string(n) + " points announced, " + std::to_string(points->size()) +
           " found");
    }
  } else if (header.data == "binary") {
    if (n * header.stride > available) truncated(n * header.stride);
    points->reserve(n);
    const char* row = bytes.data() + header.end;
    for (std::size_t k = 0; k < n; ++k, row += header.stride) {
      points->emplace_back(Load(row + axes[0]->offset, *axes[0]), Load(row + axes[1]->offset, *axes[1]),
                           Load(row + axes[2]->offset, *axes[2]));
    }
  } else if (header.data == "binary_compressed") {
    std::uint32_t sizes[2];  // compressed, uncompressed
    if (available < sizeof sizes) truncated(sizeof sizes);
    std::memcpy(sizes, bytes.data() + header.end, sizeof sizes);
    if (sizes[0] > available - sizeof sizes) truncated(sizes[0] + sizeof sizes);
    if (sizes[1] != n * header.stride)
      Fail("the uncompressed size in the file does not agree with POINTS and FIELDS");
    if (sizes[1] / 300 > sizes[0])
      Fail("the compressed size is absurd");  // LZF packs 264 : 1 at the very best
    std::vector<char> raw(sizes[1]);
    if (!DecompressLzf(reinterpret_cast<const std::uint8_t*>(bytes.data() + header.end + sizeof sizes),
                       sizes[0], reinterpret_cast<std::uint8_t*>(raw.data()), raw.size())) {
      Fail("the compressed data is damaged; copy or export the file again");
    }
    points->reserve(n);
    for (std::size_t k = 0; k < n; ++k) {  // field by field: all x, then all y, ...
      Eigen::Vector3f p;
      for (int axis = 0; axis < 3; ++axis) {
        const Field& f = *axes[axis];
        p[axis] = Load(raw.data() + f.offset * n + k * f.size * f.count, f);
      }
      points->push_back(p);
    }
  } else {
    Fail("DATA \"" + header.data + "\" is not known; expected ascii, binary or binary_compressed");
  }
}

}  // namespace evit
