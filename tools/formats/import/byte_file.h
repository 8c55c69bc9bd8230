#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace evit::formats {

/// A binary file, read from front to back in blocks. All failures are std::runtime_error naming file and
/// remedy.
class ByteFile {
 public:
  explicit ByteFile(const std::string& path);

  /// Makes up to `size` further bytes available behind those that are not used up yet; false at the end of
  /// the file.
  bool Fill(std::size_t size);
  /// What is available.
  const std::uint8_t* data() const { return buffer_.data() + used_; }
  std::size_t available() const { return buffer_.size() - used_; }
  void Use(std::size_t n) { used_ += n; }
  /// Exactly `n` bytes, valid until the next call; throws where the file ends before (`field` says what was
  /// read) or `n` is more than is left of it.
  const std::uint8_t* Take(std::uint64_t n, const char* field);
  void Skip(std::uint64_t n, const char* field);
  void Seek(std::uint64_t position);

  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return n_read_ - available(); }  // of data() in the file
  double share() const;                                             // of the file that was used up, 0..1
  const std::string& path() const { return path_; }
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<std::uint8_t> buffer_;
  std::size_t used_ = 0;
  std::uint64_t size_ = 0, n_read_ = 0;
};

}  // namespace evit::formats
