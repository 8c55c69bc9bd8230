#include "common/files/made_folder.h"

#include <system_error>

namespace evit {
namespace {

namespace fs = std::filesystem;

// As it is written, without a slash at the end; absolute, so that a change of directory does not matter.
fs::path Clean(const std::string& path) {
  const fs::path clean = fs::absolute(path).lexically_normal();
  return clean.has_filename() ? clean : clean.parent_path();
}

}  // namespace

MadeFolder::MadeFolder(const std::string& path) : path_(Clean(path)) {
  std::error_code ignored;
  for (fs::path part = path_; part.has_relative_path() && !fs::exists(part, ignored);
       part = part.parent_path())
    ++missing_;
}

bool MadeFolder::Remove() const {
  if (missing_ == 0) return false;
  std::error_code ignored;
  const auto removed = fs::remove_all(path_, ignored);
  fs::path part = path_.parent_path();
  for (int k = 1; k < missing_ && fs::remove(part, ignored); ++k) part = part.parent_path();
  return removed > 0 && removed != static_cast<std::uintmax_t>(-1);
}

}  // namespace evit
