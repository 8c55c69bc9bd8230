#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace evit::fuzz {

/// Bytes as a file in memory, for readers that take a path. One at a time. It has a name of its own: HDF5
/// asks for the real path of what it opens, which a memfd has not.
class TemporaryFile {
 public:
  TemporaryFile(const std::uint8_t* data, std::size_t size) {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr) return;
    std::fwrite(data, 1, size, file);
    std::fclose(file);
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  const std::string path_ =
      (access("/dev/shm", W_OK) == 0 ? "/dev/shm/evit_fuzz_" : "/tmp/evit_fuzz_") + std::to_string(getpid());
};

}  // namespace evit::fuzz
