#include "tools/formats/numpy/npy_header.h"

#include <cstring>
#include <fstream>
#include <regex>

namespace evit::formats {
namespace {

constexpr char kMagic[] = "\x93NUMPY";
constexpr std::size_t kMagicSize = 6;
constexpr std::uint32_t kMaxHeader = 1 << 16;
constexpr int kMaxFields = 64;

template <typename T>
T As(const std::uint8_t* data) {
  T value;
  std::memcpy(&value, data, sizeof(T));
  return value;
}

NpyHeader::Field ParseType(const ByteFile& file, const std::string& name, const std::string& type,
                           std::size_t offset) {
  static const std::regex kType("([<>|=]?)([iufb])([1248])");
  std::smatch match;
  if (!std::regex_match(type, match, kType) || match[1] == ">" ||
      (match[2] == "f" && (match[3] == "1" || match[3] == "2")) || (match[2] == "b" && match[3] != "1"))
    file.Fail("the array's type " + type +
              " is not read; save it as little-endian integers or floats: a.astype(...)");
  return {name, match[2].str()[0], std::stoi(match[3]), offset};
}

// "'t', '<i8'), ('x', '<u2'" and so on.
void ParseFields(const ByteFile& file, const std::string& text, NpyHeader* header) {
  static const std::regex kField(R"(\(\s*'([^']*)'\s*,\s*'([^']*)'\s*\))");
  for (std::sregex_iterator at(text.begin(), text.end(), kField); at != std::sregex_iterator(); ++at) {
    header->fields.push_back(ParseType(file, (*at)[1], (*at)[2], header->row_bytes));
    header->row_bytes += static_cast<std::size_t>(header->fields.back().bytes);
    if (header->fields.size() > kMaxFields) file.Fail("the array has too many fields for one of events");
  }
}

std::vector<std::uint64_t> ParseShape(const ByteFile& file, const std::string& text) {
  static const std::regex kShape(R"('shape'\s*:\s*\(([0-9, ]*)\))"), kNumber("[0-9]+");
  std::smatch match;
  if (!std::regex_search(text, match, kShape)) file.Fail("the header says no shape: it is damaged");
  std::vector<std::uint64_t> shape;
  const std::string numbers = match[1];
  for (std::sregex_iterator at(numbers.begin(), numbers.end(), kNumber); at != std::sregex_iterator(); ++at) {
    if (at->str().size() > 15) file.Fail("the header's shape is no array's: it is damaged");
    shape.push_back(std::stoull(at->str()));
  }
  return shape;
}

}  // namespace

bool IsNpy(const std::string& path) {
  char magic[kMagicSize] = {};
  std::ifstream file(path, std::ios::binary);
  return file.read(magic, kMagicSize) && std::memcmp(magic, kMagic, kMagicSize) == 0;
}

NpyHeader ReadNpyHeader(ByteFile* file) {
  const std::uint8_t* begin = file->Take(8, "the header");
  if (std::memcmp(begin, kMagic, kMagicSize) != 0) file->Fail("is no numpy file");
  const bool long_size = begin[6] >= 2;
  const std::uint8_t* bytes = file->Take(long_size ? 4 : 2, "the header");
  const std::uint32_t size = long_size ? As<std::uint32_t>(bytes) : As<std::uint16_t>(bytes);
  if (size > kMaxHeader) file->Fail("the header is too long: it is damaged");
  const std::string text(reinterpret_cast<const char*>(file->Take(size, "the header")), size);
  static const std::regex kFortran(R"('fortran_order'\s*:\s*True)"), kPlain(R"('descr'\s*:\s*'([^']*)')");
  NpyHeader header;
  std::vector<std::uint64_t> shape = ParseShape(*file, text);
  std::smatch match;
  if (std::regex_search(text, match, kPlain)) {
    if (shape.size() != 2 || shape[1] < 1 || shape[1] > kMaxFields)
      file->Fail("expected rows of numbers (N x 4), or a structured array with t, x, y and p");
    if (std::regex_search(text, kFortran))
      file->Fail("the array is stored column by column; save np.ascontiguousarray(a)");
    for (std::uint64_t k = 0; k < shape[1]; ++k) {
      header.fields.push_back(ParseType(*file, "", match[1], header.row_bytes));
      header.row_bytes += static_cast<std::size_t>(header.fields.back().bytes);
    }
    shape.pop_back();
  } else {
    ParseFields(*file, text.substr(0, text.find("'fortran_order'")), &header);
  }
  if (shape.size() != 1 || header.fields.empty())
    file->Fail("expected rows of numbers (N x 4), or a structured array with t, x, y and p");
  header.rows = shape[0];
  if (header.rows > (file->size() - file->position()) / header.row_bytes)
    file->Fail(
        "holds fewer rows than it says, or fields that are aligned: copy it again, or save a packed array");
  return header;
}

std::int64_t NpyInteger(const NpyHeader::Field& field, const std::uint8_t* row) {
  const std::uint8_t* at = row + field.offset;
  const bool is_signed = field.kind == 'i';
  switch (field.bytes) {
    case 1:
      return is_signed ? As<std::int8_t>(at) : std::int64_t{*at};
    case 2:
      return is_signed ? As<std::int16_t>(at) : std::int64_t{As<std::uint16_t>(at)};
    case 4:
      return is_signed ? As<std::int32_t>(at) : std::int64_t{As<std::uint32_t>(at)};
    default:
      return As<std::int64_t>(at);
  }
}

double NpyNumber(const NpyHeader::Field& field, const std::uint8_t* row) {
  if (field.kind != 'f') return static_cast<double>(NpyInteger(field, row));
  const std::uint8_t* at = row + field.offset;
  return field.bytes == 4 ? static_cast<double>(As<float>(at)) : As<double>(at);
}

}  // namespace evit::formats
