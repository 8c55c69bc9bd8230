#pragma once

#include <cstdint>
#include <string>

namespace evit::formats {

/// The whole pages of an SQLite file that was cut off, in memory (mapped, not read), with a header that says
/// so; SQLite itself refuses such a file, and takes the missing end of a page for zeros.
class CutDatabase {
 public:
  /// The share of a file that is missing, by its header's number of pages; 0: it is whole, or does not say.
  static double LostShare(const std::string& path);

  /// Throws std::runtime_error naming the file where it cannot be read.
  explicit CutDatabase(const std::string& path);
  ~CutDatabase();
  CutDatabase(const CutDatabase&) = delete;
  CutDatabase& operator=(const CutDatabase&) = delete;

  std::uint8_t* data() const { return data_; }
  std::int64_t size() const { return size_; }

 private:
  std::uint8_t* data_ = nullptr;
  std::int64_t size_ = 0;
};

}  // namespace evit::formats
