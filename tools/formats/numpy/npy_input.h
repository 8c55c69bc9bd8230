#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace evit::formats {

/// The bytes of an array, from front to back: of a file, or of an entry of an archive.
class NpyInput {
 public:
  virtual ~NpyInput() = default;
  /// Exactly `n` bytes, valid until the next call; throws std::runtime_error where there are fewer.
  virtual const std::uint8_t* Take(std::uint64_t n) = 0;
  virtual void Skip(std::uint64_t n) = 0;
  virtual std::uint64_t left() const = 0;
  /// Throws std::runtime_error with the file's name and, of an archive, the entry's.
  [[noreturn]] virtual void Fail(const std::string& what) const = 0;
};

/// A file as a whole.
std::unique_ptr<NpyInput> OpenNpy(const std::string& path);

/// Whether the file is an archive (zip) with arrays in it, as numpy.savez writes it.
bool IsNpz(const std::string& path);

/// The names of the arrays in an archive, without ".npy".
std::vector<std::string> NamesInNpz(const std::string& path);

/// One array of an archive, stored or compressed (numpy.savez_compressed). Several may be open at a time.
std::unique_ptr<NpyInput> OpenInNpz(const std::string& path, const std::string& name);

}  // namespace evit::formats
