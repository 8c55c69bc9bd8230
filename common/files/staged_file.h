#pragma once

#include <filesystem>
#include <string>

namespace evit {

/// The name beside a file that is being written: PATH.part, or PATH.part.EXTENSION for libraries that tell
/// the kind of a file from its name. Whoever writes fills part(); Commit() gives it its own name. Until then
/// an earlier version stays, and after an error or a signal (RemoveStagedFilesOnSignals) nothing is left
/// behind. A symbolic link is followed, so that the file it points at is the one replaced.
class StagedFile {
 public:
  enum class Name { kPart, kPartExtension };

  explicit StagedFile(const std::string& path, Name name = Name::kPart);
  /// Removes the part unless Commit() has succeeded.
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  const std::string& part() const { return part_; }

  /// Throws std::runtime_error naming the path where it cannot be written, or is no file that could be
  /// replaced: a folder, a device, a pipe.
  void Commit();

 private:
  std::string path_, part_;
  std::filesystem::path final_;
  int slot_;
};

/// A folder that is made for an output where there is none yet, with its parents. After an error or a signal
/// it is removed again if it is empty.
class StagedDirectory {
 public:
  /// Throws std::runtime_error where it cannot be made, or is a file.
  explicit StagedDirectory(const std::string& path);
  ~StagedDirectory();
  StagedDirectory(const StagedDirectory&) = delete;
  StagedDirectory& operator=(const StagedDirectory&) = delete;

 private:
  std::string path_;
  int slot_ = -1;
};

/// Makes SIGINT, SIGTERM and SIGHUP remove what is staged at that time before they end the program. Handlers
/// that are set later (StopSignals) take their place.
void RemoveStagedFilesOnSignals();

}  // namespace evit
