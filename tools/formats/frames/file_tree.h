#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace evit::formats {

/// The files of a folder or of a zip archive, by names relative to it ("left/1600000000.100000.png").
class FileTree {
 public:
  virtual ~FileTree() = default;
  /// Of a folder those two levels down and no deeper, of an archive all; without what a Mac adds.
  virtual const std::vector<std::string>& names() const = 0;
  virtual bool Has(const std::string& name) const = 0;
  /// What messages call it.
  virtual std::string PathOf(const std::string& name) const = 0;
  /// Throws std::runtime_error naming the file: not there, damaged, encrypted, or of more than 256 MB.
  virtual std::vector<std::uint8_t> Read(const std::string& name) = 0;
};

/// Throws std::runtime_error naming the path: neither a folder nor a zip archive, or a damaged one.
std::unique_ptr<FileTree> OpenFileTree(const std::string& path);

}  // namespace evit::formats
