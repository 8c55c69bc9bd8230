#include "common/service/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <stdexcept>

namespace evit {
namespace {

constexpr std::int64_t kMagic = 0x4556495430303032;  // "EVIT0002"

}  // namespace

// Two places follow, written in turn: the one that `stored` names is always whole.
struct MappedFile::Head {
  std::int64_t magic, identity, size;
  std::atomic<std::uint64_t> stored;  // how often; odd: the second place is the newest
};

MappedFile::MappedFile(const std::string& path, std::int64_t identity, std::size_t size) : size_(size) {
  const auto fail = [&] {
    throw std::runtime_error(path + ": cannot be used to keep what a restart needs: " + std::strerror(errno) +
                             "; give a path in a folder that can be written");
  };
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) fail();
  const std::size_t whole = sizeof(Head) + 2 * size;
  struct stat status {};
  const bool fits = fstat(fd, &status) == 0 && status.st_size == static_cast<off_t>(whole);
  void* memory = MAP_FAILED;
  if (ftruncate(fd, static_cast<off_t>(whole)) == 0) {
    memory = mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  }
  close(fd);
  if (memory == MAP_FAILED) fail();
  head_ = static_cast<Head*>(memory);
  const auto size64 = static_cast<std::int64_t>(size);
  if (fits && head_->magic == kMagic && head_->identity == identity && head_->size == size64) return;
  head_->magic = kMagic;
  head_->identity = identity;
  head_->size = size64;
  head_->stored = 0;
}

MappedFile::~MappedFile() { munmap(head_, sizeof(Head) + 2 * size_); }

unsigned char* MappedFile::Place(std::uint64_t k) const {
  return reinterpret_cast<unsigned char*>(head_ + 1) + (k % 2) * size_;
}

const void* MappedFile::Load() const {
  const std::uint64_t stored = head_->stored.load(std::memory_order_acquire);
  return stored == 0 ? nullptr : Place(stored);
}

void MappedFile::Store(const void* block) {
  const std::uint64_t stored = head_->stored.load(std::memory_order_relaxed) + 1;
  std::memcpy(Place(stored), block, size_);
  head_->stored.store(stored, std::memory_order_release);
}

void MappedFile::Clear() { head_->stored = 0; }

}  // namespace evit
