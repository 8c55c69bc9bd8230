#include "tools/formats/aedat/flat_table.h"

#include <cstring>
#include <stdexcept>

namespace evit::formats {
namespace {

[[noreturn]] void Fail() {
  throw std::runtime_error("a packet's contents are damaged (FlatBuffers offsets leave it)");
}

}  // namespace

template <typename Number>
Number FlatTable::Load(std::size_t at) const {
  if (at > size_ || size_ - at < sizeof(Number)) Fail();
  Number value;
  std::memcpy(&value, data_ + at, sizeof value);
  return value;
}

std::size_t FlatTable::Follow(std::size_t at) const {
  const std::size_t to = at + Load<std::uint32_t>(at);
  if (to >= size_) Fail();
  return to;
}

FlatTable FlatTable::Root(const std::uint8_t* data, std::size_t size, const char* identifier) {
  FlatTable whole(data, size, 0);
  if (size < 12 || std::memcmp(data + 8, identifier, 4) != 0)
    throw std::runtime_error(std::string("a packet is not of type ") + identifier);
  return {data, size, whole.Follow(4)};
}

std::size_t FlatTable::FieldAt(int field) const {
  const std::int64_t table = static_cast<std::int64_t>(at_) - Load<std::int32_t>(at_);
  if (table < 0) Fail();
  const auto vtable = static_cast<std::size_t>(table);
  const std::size_t slot = 4 + 2 * static_cast<std::size_t>(field);
  if (slot + 2 > Load<std::uint16_t>(vtable)) return 0;
  const std::uint16_t offset = Load<std::uint16_t>(vtable + slot);
  return offset == 0 ? 0 : at_ + offset;
}

template <typename Number>
Number FlatTable::Get(int field, Number otherwise) const {
  const std::size_t at = FieldAt(field);
  return at == 0 ? otherwise : Load<Number>(at);
}
template std::int32_t FlatTable::Get(int, std::int32_t) const;
template std::int64_t FlatTable::Get(int, std::int64_t) const;
template float FlatTable::Get(int, float) const;

const std::uint8_t* FlatTable::Vector(std::size_t at, std::size_t item, std::size_t* n) const {
  const std::size_t begin = Follow(at);
  *n = Load<std::uint32_t>(begin);
  if (*n > (size_ - begin - 4) / item) Fail();
  return data_ + begin + 4;
}

std::string_view FlatTable::String(int field) const {
  const std::size_t at = FieldAt(field);
  if (at == 0) return {};
  std::size_t n = 0;
  const std::uint8_t* text = Vector(at, 1, &n);
  return {reinterpret_cast<const char*>(text), n};
}

const std::uint8_t* FlatTable::Structs(int field, std::size_t item, std::size_t* n) const {
  *n = 0;
  const std::size_t at = FieldAt(field);
  return at == 0 ? data_ : Vector(at, item, n);
}

std::vector<FlatTable> FlatTable::Tables(int field) const {
  std::vector<FlatTable> tables;
  const std::size_t at = FieldAt(field);
  if (at == 0) return tables;
  std::size_t n = 0;
  const std::uint8_t* offsets = Vector(at, 4, &n);
  for (std::size_t k = 0; k < n; ++k)
    tables.push_back({data_, size_, Follow(static_cast<std::size_t>(offsets - data_) + 4 * k)});
  return tables;
}

}  // namespace evit::formats
