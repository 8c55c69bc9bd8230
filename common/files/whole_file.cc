#include "common/files/whole_file.h"

#include <stdexcept>

namespace evit {

WholeFile::WholeFile(const std::string& path)
    : path_(path), file_(path), stream_(file_.part(), std::ios::binary) {}

void WholeFile::Commit() {
  stream_.close();
  if (!stream_)
    throw std::runtime_error(path_ +
                             ": cannot be written; check that the folder exists, is writable and has room");
  file_.Commit();
}

}  // namespace evit
