#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "common/map/map_formats.h"
#include "common/text/words.h"

namespace evit {
namespace {

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error(what); }

enum class Kind { kFloat, kSigned, kUnsigned };

struct Type {
  std::size_t size = 0;
  Kind kind = Kind::kFloat;
};

Type TypeOf(const std::string& name) {
  if (name == "float" || name == "float32") return {4, Kind::kFloat};
  if (name == "double" || name == "float64") return {8, Kind::kFloat};
  if (name == "char" || name == "int8") return {1, Kind::kSigned};
  if (name == "uchar" || name == "uint8") return {1, Kind::kUnsigned};
  if (name == "short" || name == "int16") return {2, Kind::kSigned};
  if (name == "ushort" || name == "uint16") return {2, Kind::kUnsigned};
  if (name == "int" || name == "int32") return {4, Kind::kSigned};
  if (name == "uint" || name == "uint32") return {4, Kind::kUnsigned};
  Fail("type \"" + name + "\" is not known");
}

struct Property {
  std::string name;
  Type type;
  bool list = false;
  Type count_type;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

// Bytes that one row takes at least: the last of an ascii file is "0 0 0" without a newline.
std::size_t SmallestRow(const Element& element, const std::string& encoding) {
  std::size_t size = 0;
  for (const Property& p : element.properties) {
    size += encoding == "ascii" ? 1 : (p.list ? p.count_type.size : p.type.size);
  }
  return size;
}

void RequireCoordinates(const Element& vertex) {
  for (const char* axis : {"x", "y", "z"}) {
    if (std::none_of(vertex.properties.begin(), vertex.properties.end(),
                     [&](const Property& p) { return p.name == axis && !p.list; })) {
      Fail(std::string("the vertex element has no property ") + axis);
    }
  }
}

// One number of a binary file, in either byte order.
double Load(const char* data, const Type& type, bool swap) {
  char b[8];
  std::memcpy(b, data, type.size);
  if (swap) std::reverse(b, b + type.size);
  const auto as = [&](auto value) {
    std::memcpy(&value, b, sizeof value);
    return static_cast<double>(value);
  };
  if (type.kind == Kind::kFloat) return type.size == 4 ? as(float{}) : as(double{});
  switch (type.size) {
    case 1:
      return type.kind == Kind::kSigned ? as(std::int8_t{}) : as(std::uint8_t{});
    case 2:
      return type.kind == Kind::kSigned ? as(std::int16_t{}) : as(std::uint16_t{});
    default:
      return type.kind == Kind::kSigned ? as(std::int32_t{}) : as(std::uint32_t{});
  }
}

// Hands out the numbers of a PLY body one after the other, whatever its encoding.
class Numbers {
 public:
  Numbers(const std::string& bytes, std::size_t begin, const std::string& format)
      : bytes_(bytes), at_(begin), ascii_(format == "ascii"), swap_(format == "binary_big_endian") {
    if (!ascii_ && !swap_ && format != "binary_little_endian") Fail("format \"" + format + "\" is not known");
  }
  double Next(const Type& type) {
    if (ascii_) {
      while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0) ++at_;
      if (at_ >= bytes_.size()) Fail("truncated: the data ends early; copy the file again");
      char* end = nullptr;
      const double value = std::strtod(bytes_.c_str() + at_, &end);
      if (end == bytes_.c_str() + at_) Fail("byte " + std::to_string(at_) + ": expected a number");
      at_ = static_cast<std::size_t>(end - bytes_.c_str());
      return value;
    }
    if (type.size > bytes_.size() - at_) Fail("truncated: the data ends early; copy the file again");
    const double value = Load(bytes_.data() + at_, type, swap_);
    at_ += type.size;
    return value;
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const std::string& bytes_;
  std::size_t at_;
  bool ascii_, swap_;
};

// "property TYPE NAME" or "property list TYPE TYPE NAME", after its first word.
Property ReadProperty(std::istringstream* words) {
  Property property;
  std::string type;
  *words >> type;
  property.list = type == "list";
  if (property.list) {
    *words >> type;
    property.count_type = TypeOf(type);
    *words >> type;
  }
  property.type = TypeOf(type);
  *words >> property.name;
  return property;
}

struct Header {
  std::string encoding;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes
};

Header ReadHeader(const std::string& bytes) {
  Header header;
  while (true) {
    std::string line;
    if (!HeaderLine(bytes, &header.size, &line)) Fail("the PLY header has no end_header line");
    std::istringstream words(LowerCase(line));
    std::string key;
    words >> key;
    if (key == "format") {
      words >> header.encoding;
    } else if (key == "element") {
      Element element;
      if (!(words >> element.name >> element.count)) Fail("an element line lacks name or count");
      header.elements.push_back(element);
    } else if (key == "property") {
      if (header.elements.empty()) Fail("a property comes before any element");
      header.elements.back().properties.push_back(ReadProperty(&words));
    } else if (key == "end_header") {
      return header;
    }
  }
}

// A forged count is found before memory is reserved for it.
void RequireRows(const Element& element, const std::string& encoding, std::size_t left) {
  if (element.count <= left / std::max<std::size_t>(1, SmallestRow(element, encoding))) return;
  Fail("truncated: element " + element.name + " announces " + std::to_string(element.count) +
       " rows, more than the file holds; copy the file again");
}

// One row: its coordinates, NaN where it has none, and its intensity, where asked for.
Eigen::Vector3d ReadRow(const Element& element, Numbers* numbers, std::vector<float>* intensities) {
  Eigen::Vector3d p = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (const Property& property : element.properties) {
    if (property.list) {
      const double n = numbers->Next(property.count_type);
      if (!(n >= 0 && n <= static_cast<double>(numbers->left()))) Fail("a list's count is absurd");
      for (double i = 0; i < n; ++i) numbers->Next(property.type);
      continue;
    }
    const double value = numbers->Next(property.type);
    if (property.name == "x" || property.name == "y" || property.name == "z") {
      p[property.name[0] - 'x'] = value;
    } else if (intensities != nullptr && property.name == "intensity") {
      intensities->push_back(static_cast<float>(value));
    }
  }
  return p;
}

}  // namespace

void ReadPly(const std::string& bytes, CloudPoints* points, std::string* format,
             std::vector<float>* intensities) {
  const Header header = ReadHeader(bytes);
  *format = "PLY " + header.encoding;
  Numbers numbers(bytes, header.size, header.encoding);
  for (const Element& element : header.elements) {
    const bool vertex = element.name == "vertex";
    if (vertex) RequireCoordinates(element);
    RequireRows(element, header.encoding, numbers.left());
    if (vertex) points->reserve(element.count);
    for (std::size_t k = 0; k < element.count; ++k) {
      const Eigen::Vector3d p = ReadRow(element, &numbers, vertex ? intensities : nullptr);
      if (vertex) points->push_back(p);
    }
    if (vertex) return;
  }
  Fail("there is no vertex element");
}

}  // namespace evit
