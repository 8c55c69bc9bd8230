#include "common/bus/wire_layout.h"

#include <array>
#include <cstring>

namespace evit {

namespace {

/// Walks over a message's bytes and never past their end.
class WireCursor {
 public:
  WireCursor(const std::uint8_t* data, std::size_t size, std::string* why)
      : data_(data), left_(static_cast<std::int64_t>(size)), why_(why) {}

  bool Skip(std::int64_t bytes, const char* what) {
    if (bytes > left_) {
      return Fail(std::string("cut off in ") + what + ": " + std::to_string(bytes) + " bytes needed, " +
                  std::to_string(left_) + " left");
    }
    data_ += bytes;
    left_ -= bytes;
    return true;
  }

  bool ReadInt32(std::int32_t* value, const char* what) {
    const std::uint8_t* at = data_;
    if (!Skip(4, what)) return false;
    *value = static_cast<std::int32_t>(
        static_cast<std::uint32_t>(at[0]) << 24 | static_cast<std::uint32_t>(at[1]) << 16 |
        static_cast<std::uint32_t>(at[2]) << 8 | static_cast<std::uint32_t>(at[3]));
    return true;
  }

  bool ReadFingerprint(std::int64_t expected) {
    const std::uint8_t* at = data_;
    if (!Skip(8, "the fingerprint")) return false;
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value = value << 8 | at[i];
    if (value == static_cast<std::uint64_t>(expected)) return true;
    return Fail("wrong fingerprint: another message type, or another version of it");
  }

  bool ReadText(const char* name) {
    std::int32_t length = 0;
    if (!ReadInt32(&length, name)) return false;
    if (length < 1 || length > kMaxText) {
      return Fail(std::string("length of ") + name + " is " + std::to_string(length) + ", not 1.." +
                  std::to_string(kMaxText));
    }
    const auto* text = reinterpret_cast<const char*>(data_);
    if (!Skip(length, name)) return false;
    if (strnlen(text, length) != static_cast<std::size_t>(length) - 1) {
      return Fail(std::string(name) + " is not a string closed by its only NUL");
    }
    return true;
  }

  bool AtEnd() { return left_ == 0 || Fail(std::to_string(left_) + " bytes too many"); }

  bool Fail(const std::string& reason) {
    if (why_ != nullptr) *why_ = reason;
    return false;
  }

 private:
  const std::uint8_t* data_;
  std::int64_t left_;
  std::string* why_;
};

/// The counts read so far, by name.
class Counts {
 public:
  void Add(const char* name, std::int32_t value) { counts_.at(n_++) = {name, value}; }
  std::int64_t Get(const char* name) const {
    for (std::size_t i = 0; i < n_; ++i) {
      if (std::strcmp(counts_[i].name, name) == 0) return counts_[i].value;
    }
    return 0;  // a layout that names no count: its round-trip test fails
  }

 private:
  struct Named {
    const char* name = nullptr;
    std::int32_t value = 0;
  };
  std::array<Named, kMaxCounts> counts_;
  std::size_t n_ = 0;
};

bool CheckField(const WireField& field, WireCursor* cursor, Counts* counts) {
  switch (field.kind) {
    case WireField::Kind::kBytes:
      return cursor->Skip(field.size, "the fixed fields");
    case WireField::Kind::kCount: {
      std::int32_t value = 0;
      if (!cursor->ReadInt32(&value, field.name)) return false;
      if (value < 0 || value > field.maximum) {
        return cursor->Fail(std::string(field.name) + " is " + std::to_string(value) + ", not 0.." +
                            std::to_string(field.maximum));
      }
      counts->Add(field.name, value);
      return true;
    }
    case WireField::Kind::kArray: {
      // Counts are below 2^25 and elements below 2^10 bytes: this product fits 64 bits.
      const std::int64_t columns = field.columns == nullptr ? 1 : counts->Get(field.columns);
      return cursor->Skip(field.size * (counts->Get(field.rows) * columns), field.rows);
    }
    case WireField::Kind::kText: {
      const std::int64_t n = field.rows == nullptr ? 1 : counts->Get(field.rows);
      for (std::int64_t i = 0; i < n; ++i) {
        if (!cursor->ReadText(field.name)) return false;
      }
      return true;
    }
    case WireField::Kind::kGroup: {
      const std::int64_t n = counts->Get(field.rows);
      for (std::int64_t i = 0; i < n; ++i) {
        for (const WireField& inner : *field.fields) {
          if (!CheckField(inner, cursor, counts)) return false;
        }
      }
      return true;
    }
  }
  return false;
}

}  // namespace

bool CheckWire(const WireLayout& layout, std::int64_t fingerprint, const std::uint8_t* data, std::size_t size,
               std::string* why) {
  WireCursor cursor(data, size, why);
  if (!cursor.ReadFingerprint(fingerprint)) return false;
  Counts counts;
  for (const WireField& field : layout) {
    if (!CheckField(field, &cursor, &counts)) return false;
  }
  return cursor.AtEnd();
}

}  // namespace evit
