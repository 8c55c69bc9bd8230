#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>

namespace evit {

/// A block of bytes in a file that is mapped into memory: storing costs as much as copying it, and what was
/// stored last is there, whole, even if this process is killed at that very moment. For what a restarted
/// service needs.
class MappedFile {
 public:
  /// `identity`: what the block belongs to; one of another identity or size is not loaded. The file is made
  /// where it is not there. Throws std::runtime_error, naming the file, where it cannot be.
  MappedFile(const std::string& path, std::int64_t identity, std::size_t size);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// The newest block; null where nothing was stored.
  const void* Load() const;
  void Store(const void* block);
  void Clear();

 private:
  struct Head;
  unsigned char* Place(std::uint64_t k) const;

  std::size_t size_;
  Head* head_ = nullptr;
};

/// The same for a type without pointers.
template <typename T>
class MappedRecord {
 public:
  static_assert(std::is_trivially_copyable_v<T>);
  MappedRecord(const std::string& path, std::int64_t identity) : file_(path, identity, sizeof(T)) {}

  std::optional<T> Load() const {
    const void* block = file_.Load();
    if (block == nullptr) return std::nullopt;
    T record;
    std::memcpy(&record, block, sizeof(T));
    return record;
  }
  void Store(const T& record) { file_.Store(&record); }
  void Clear() { file_.Clear(); }

 private:
  MappedFile file_;
};

}  // namespace evit
