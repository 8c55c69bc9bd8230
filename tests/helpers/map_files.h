#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "common/map/map_file.h"

/// Files for the tests of the map readers.
namespace evit::test {

/// A file of this test process's own, gone with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& bytes, const std::string& name = "cloud")
      : path_(::testing::TempDir() + "map_" + std::to_string(::getpid()) + "_" + name) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline LoadedMap Load(const std::string& bytes) { return LoadMap(TemporaryFile(bytes).path()); }

/// What loading these bytes says is wrong; empty where nothing is. The message must name the file.
inline std::string LoadError(const std::string& bytes) {
  const TemporaryFile file(bytes);
  try {
    LoadMap(file.path());
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.rfind(file.path() + ": ", 0), 0u) << what;
    return what.substr(file.path().size());
  }
  return "";
}

/// The bytes of a number as this machine keeps it (little-endian), or the other way round.
template <typename Number>
std::string Raw(Number value, bool swap = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return swap ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

}  // namespace evit::test
