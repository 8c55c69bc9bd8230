#include "common/files/whole_file.h"

#include <cstdio>
#include <stdexcept>
#include <utility>

namespace evit {

WholeFile::WholeFile(std::string path)
    : path_(std::move(path)), part_(path_ + ".part"), stream_(part_, std::ios::binary) {}

WholeFile::~WholeFile() {
  if (part_.empty()) return;
  stream_.close();
  std::remove(part_.c_str());
}

void WholeFile::Commit() {
  stream_.close();
  if (!stream_ || std::rename(part_.c_str(), path_.c_str()) != 0) {
    throw std::runtime_error(path_ +
                             ": cannot be written; check that the folder exists, is writable and has room");
  }
  part_.clear();
}

}  // namespace evit
