#pragma once

#include <fstream>
#include <string>

namespace evit {

/// Writes a file that appears under its name only when it is complete: a reader never sees half of it, and an
/// earlier version stays until then.
class WholeFile {
 public:
  /// Opens PATH.part.
  explicit WholeFile(std::string path);
  /// Removes what was written unless Commit() has succeeded.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  std::ofstream& stream() { return stream_; }

  /// Closes the file and gives it its name. Throws std::runtime_error naming it where anything failed since
  /// the construction.
  void Commit();

 private:
  std::string path_, part_;
  std::ofstream stream_;
};

}  // namespace evit
