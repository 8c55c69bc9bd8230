#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace evit {

/// One field of a message as LCM puts it on the wire (big-endian, no padding), or a run of fixed-size fields.
struct WireField {
  enum class Kind { kBytes, kCount, kArray, kText, kGroup };
  Kind kind;
  int size;              // kBytes: bytes in all; kArray: bytes per element
  const char* name;      // kCount, kText: of the field
  std::int32_t maximum;  // kCount: largest value accepted (the smallest is 0)
  // kArray, kGroup: the count that says how many; kText: null for one string, else the count.
  const char* rows;
  const char* columns;                             // kArray: second count, null where there is none
  const std::vector<WireField>* fields = nullptr;  // kGroup: of each element; must outlive the layout
};

/// All fields in order, the fingerprint before them not counted.
using WireLayout = std::vector<WireField>;

/// `n` bytes of fields of fixed size.
constexpr WireField Bytes(int n) { return {WireField::Kind::kBytes, n, nullptr, 0, nullptr, nullptr}; }
/// An int32 that later fields use as their length.
constexpr WireField Count(const char* name, std::int32_t maximum) {
  return {WireField::Kind::kCount, 4, name, maximum, nullptr, nullptr};
}
/// `rows` (times `columns`) elements of `bytes` each.
constexpr WireField Array(int bytes, const char* rows, const char* columns = nullptr) {
  return {WireField::Kind::kArray, bytes, nullptr, 0, rows, columns};
}
/// A string, or `rows` strings: int32 length with the closing NUL, then the characters.
constexpr WireField Text(const char* name, const char* rows = nullptr) {
  return {WireField::Kind::kText, 0, name, 0, rows, nullptr};
}
/// `rows` elements, each of them these fields in a row (no counts among them).
constexpr WireField Group(const WireLayout* fields, const char* rows) {
  return {WireField::Kind::kGroup, 0, nullptr, 0, rows, nullptr, fields};
}

/// Counts that one layout may have.
constexpr std::size_t kMaxCounts = 8;

/// Longest string accepted, bytes.
constexpr std::int32_t kMaxText = 1 << 16;

/// True where `data` is exactly one message of this layout: fingerprint, every count within its limits, every
/// string closed, no byte missing and none left over. Looks at the bytes only and reserves nothing. Otherwise
/// false, and `why`, where not null, says what is wrong.
bool CheckWire(const WireLayout& layout, std::int64_t fingerprint, const std::uint8_t* data, std::size_t size,
               std::string* why);

/// The layout of each message, generated from its .lcm file (generator/message_code.h).
template <typename Message>
const WireLayout& LayoutOf();

}  // namespace evit
