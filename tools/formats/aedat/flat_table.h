#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace evit::formats {

/// A table in a FlatBuffers message (flatbuffers.dev, "internals"), each access checked against the message's
/// end: bytes of a file are not to be trusted. All throw std::runtime_error where they would leave it.
class FlatTable {
 public:
  /// The root of a message with its size in front, of the type that the identifier (four letters) names.
  static FlatTable Root(const std::uint8_t* data, std::size_t size, const char* identifier);

  /// The field with this index in the schema, or `otherwise` where it is left out.
  template <typename Number>
  Number Get(int field, Number otherwise) const;
  std::string_view String(int field) const;  // empty where it is left out
  /// A vector of structs of `item` bytes: its first byte, and how many there are.
  const std::uint8_t* Structs(int field, std::size_t item, std::size_t* n) const;
  std::vector<FlatTable> Tables(int field) const;

 private:
  FlatTable(const std::uint8_t* data, std::size_t size, std::size_t at) : data_(data), size_(size), at_(at) {}
  template <typename Number>
  Number Load(std::size_t at) const;
  std::size_t Follow(std::size_t at) const;  // an offset to where it points
  std::size_t FieldAt(int field) const;      // 0: left out
  const std::uint8_t* Vector(std::size_t at, std::size_t item, std::size_t* n) const;

  const std::uint8_t* data_;
  std::size_t size_, at_;
};

}  // namespace evit::formats
