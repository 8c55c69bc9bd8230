#include "tools/formats/ros2/cut_database.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tools/formats/import/byte_file.h"

namespace evit::formats {
namespace {

// SQLite's file format, 1.3: numbers in the header, big-endian.
constexpr std::size_t kHeader = 100;
constexpr int kPageSize = 16, kWriteVersion = 18, kReadVersion = 19, kChanges = 24, kPages = 28,
              kPagesValidFor = 92;

std::uint64_t Number(const std::uint8_t* at, int n) {
  std::uint64_t value = 0;
  for (int k = 0; k < n; ++k) value = value << 8 | at[k];
  return value;
}

// A page of 65536 bytes is written as 1.
std::uint64_t PageSize(const std::uint8_t* header) {
  const std::uint64_t size = Number(header + kPageSize, 2);
  return size == 1 ? 65536 : size;
}

}  // namespace

double CutDatabase::LostShare(const std::string& path) {
  ByteFile file(path);
  if (!file.Fill(kHeader) || file.available() < kHeader) return 0;
  const std::uint8_t* header = file.data();
  const std::uint64_t pages = Number(header + kPages, 4);
  if (pages == 0 || Number(header + kChanges, 4) != Number(header + kPagesValidFor, 4)) return 0;
  const auto whole = static_cast<double>(PageSize(header) * pages);
  return std::max(0.0, 1 - static_cast<double>(std::filesystem::file_size(path)) / whole);
}

CutDatabase::CutDatabase(const std::string& path) {
  const auto fail = [&path] { throw std::runtime_error(path + ": cannot be read"); };
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail();
  size_ = lseek(file, 0, SEEK_END);
  if (size_ < static_cast<std::int64_t>(kHeader)) {
    close(file);
    fail();
  }
  // Private: what is changed here does not get into the file.
  void* mapped = mmap(nullptr, static_cast<std::size_t>(size_), PROT_READ | PROT_WRITE, MAP_PRIVATE, file, 0);
  close(file);
  if (mapped == MAP_FAILED) fail();
  data_ = static_cast<std::uint8_t*>(mapped);
  const std::uint64_t page = PageSize(data_), pages = page > 0 ? static_cast<std::uint64_t>(size_) / page : 0;
  for (int k = 0; k < 4; ++k) data_[kPages + k] = static_cast<std::uint8_t>(pages >> 8 * (3 - k));
  data_[kWriteVersion] = data_[kReadVersion] = 1;  // a write-ahead log is not looked for
}

CutDatabase::~CutDatabase() {
  if (data_ != nullptr) munmap(data_, static_cast<std::size_t>(size_));
}

}  // namespace evit::formats
