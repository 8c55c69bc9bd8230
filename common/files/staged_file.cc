#include "common/files/staged_file.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace evit {
namespace {

namespace fs = std::filesystem;

// What a signal handler may look at: fixed memory, each slot in use only while `used` says so.
struct Slot {
  enum State : int { kFree, kClaimed, kFile, kDirectory };
  std::atomic<int> state{kFree};
  std::array<char, 4096> path;
};
std::array<Slot, 32> g_slots;
static_assert(std::atomic<int>::is_always_lock_free);

// Slot number; -1 where all are taken or the path is too long: then a signal leaves this one behind.
int Claim(const std::string& path, Slot::State state) {
  if (path.size() >= sizeof Slot::path) return -1;
  for (std::size_t k = 0; k < g_slots.size(); ++k) {
    int expected = Slot::kFree;
    if (!g_slots[k].state.compare_exchange_strong(expected, Slot::kClaimed)) continue;
    std::memcpy(g_slots[k].path.data(), path.c_str(), path.size() + 1);
    g_slots[k].state = state;
    return static_cast<int>(k);
  }
  return -1;
}

void Release(int slot) {
  if (slot >= 0) g_slots[static_cast<std::size_t>(slot)].state = Slot::kFree;
}

void OnSignal(int signal) {
  for (const Slot& slot : g_slots) {
    if (slot.state == Slot::kFile) unlink(slot.path.data());
  }
  for (const Slot& slot : g_slots) {
    if (slot.state == Slot::kDirectory) rmdir(slot.path.data());
  }
  std::signal(signal, SIG_DFL);  // NOLINT(cert-err33-c): cannot fail for these
  raise(signal);
}

// The file that a name stands for; relative to the folder that is current now.
fs::path Final(const std::string& path) {
  std::error_code error;
  fs::path final = path;
  for (int links = 0; links < 40 && fs::is_symlink(final, error); ++links) {
    const fs::path to = fs::read_symlink(final, error);
    if (error) break;
    final = to.is_absolute() ? to : final.parent_path() / to;
  }
  return final;
}

std::string PartName(const fs::path& final, StagedFile::Name name) {
  return final.string() + ".part" +
         (name == StagedFile::Name::kPartExtension ? final.extension().string() : "");
}

}  // namespace

StagedFile::StagedFile(const std::string& path, Name name)
    : path_(path),
      part_(PartName(Final(path), name)),
      final_(Final(path)),
      slot_(Claim(part_, Slot::kFile)) {}

StagedFile::~StagedFile() {
  if (part_.empty()) return;
  std::remove(part_.c_str());
  Release(slot_);
}

void StagedFile::Commit() {
  std::error_code error;
  if (fs::exists(final_, error) && !fs::is_regular_file(final_, error))
    throw std::runtime_error(path_ + ": is not a file that can be replaced; give another name");
  fs::rename(part_, final_, error);
  if (error)
    throw std::runtime_error(path_ +
                             ": cannot be written; check that the folder exists, is writable and has room");
  part_.clear();
  Release(slot_);
}

StagedDirectory::StagedDirectory(const std::string& path) : path_(path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    throw std::runtime_error(path + ": is a file, a folder is needed; give another name");
  const bool made = fs::create_directories(path, error);
  if (error) throw std::runtime_error(path + ": cannot be made: " + error.message());
  if (made) slot_ = Claim(path, Slot::kDirectory);
}

StagedDirectory::~StagedDirectory() {
  if (slot_ < 0) return;
  rmdir(path_.c_str());  // only if it is empty
  Release(slot_);
}

void RemoveStagedFilesOnSignals() {
  struct sigaction action = {};
  action.sa_handler = &OnSignal;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction old = {};
    sigaction(signal, nullptr, &old);
    if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);  // nohup, a shell's background
  }
}

}  // namespace evit
