#include "services/log_replay/position_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace evit {
namespace {

constexpr std::int64_t kMagic = 0x4556495430303031;  // "EVIT0001"

}  // namespace

// Two places, written in turn: the one that `newest` names is always whole.
struct PositionFile::Page {
  std::int64_t magic;
  std::int64_t recording;
  std::atomic<std::uint64_t> stored;  // how often; odd: places[1] is the newest
  ReplayPosition places[2];
};

PositionFile::PositionFile(const std::string& path, std::int64_t recording) : recording_(recording) {
  const auto fail = [&] {
    throw std::runtime_error("position file " + path + " cannot be used: " + std::strerror(errno) +
                             "; give --position a path in a folder that can be written");
  };
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) fail();
  void* memory = MAP_FAILED;
  if (ftruncate(fd, sizeof(Page)) == 0) {
    memory = mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  }
  close(fd);
  if (memory == MAP_FAILED) fail();
  page_ = static_cast<Page*>(memory);
  if (page_->magic == kMagic && page_->recording == recording_) return;
  page_->magic = kMagic;
  page_->recording = recording_;
  page_->stored = 0;
}

PositionFile::~PositionFile() { munmap(page_, sizeof(Page)); }

std::optional<ReplayPosition> PositionFile::Load() const {
  const std::uint64_t stored = page_->stored.load(std::memory_order_acquire);
  if (stored == 0) return std::nullopt;
  return page_->places[stored % 2];
}

void PositionFile::Clear() { page_->stored = 0; }

void PositionFile::Store(const ReplayPosition& position) {
  const std::uint64_t stored = page_->stored.load(std::memory_order_relaxed) + 1;
  page_->places[stored % 2] = position;
  page_->stored.store(stored, std::memory_order_release);
}

}  // namespace evit
