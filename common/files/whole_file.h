#pragma once

#include <fstream>
#include <string>

#include "common/files/staged_file.h"

namespace evit {

/// Writes a file that appears under its name only when it is complete: a reader never sees half of it, and an
/// earlier version stays until then.
class WholeFile {
 public:
  /// Opens PATH.part; removes it again unless Commit() succeeds.
  explicit WholeFile(const std::string& path);

  std::ofstream& stream() { return stream_; }

  /// Closes the file and gives it its name. Throws std::runtime_error naming it where anything failed since
  /// the construction, or it is no file that could be replaced.
  void Commit();

 private:
  std::string path_;
  StagedFile file_;  // outlives the stream
  std::ofstream stream_;
};

}  // namespace evit
