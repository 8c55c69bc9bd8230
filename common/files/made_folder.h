#pragma once

#include <filesystem>
#include <string>

namespace evit {

/// A folder that a job is about to make, with the parents that are missing, so that a job that is interrupted
/// leaves nothing behind, and keeps what was there before it.
class MadeFolder {
 public:
  /// Before anything is made.
  explicit MadeFolder(const std::string& path);

  /// Removes the folder with all that is in it, then those parents that were missing, where nothing else is
  /// in them. Nothing where the folder was there before. Whether it removed the folder.
  bool Remove() const;

 private:
  std::filesystem::path path_;
  int missing_ = 0;  // parts of the path, from its end, that were not there
};

}  // namespace evit
