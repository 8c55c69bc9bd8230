#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/formats/frames/file_tree.h"

struct zip;

namespace evit::formats {

/// A zip archive (also of more than 4 GB), read in place: nothing is unpacked to disk.
class ZipTree : public FileTree {
 public:
  /// By the first bytes.
  static bool Recognises(const std::string& path);

  explicit ZipTree(const std::string& path);
  const std::vector<std::string>& names() const override { return names_; }
  bool Has(const std::string& name) const override { return index_.count(name) > 0; }
  std::string PathOf(const std::string& name) const override { return path_ + ": " + name; }
  std::vector<std::uint8_t> Read(const std::string& name) override;

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  std::string path_;
  std::unique_ptr<zip, Close> archive_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint64_t> index_;
};

}  // namespace evit::formats
