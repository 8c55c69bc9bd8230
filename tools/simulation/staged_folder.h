#pragma once

#include <filesystem>
#include <string>

namespace evit::simulation {

/// A folder beside the final one that becomes it only when everything is written.
class StagedFolder {
 public:
  /// Throws std::runtime_error where the folder cannot be made or is a file.
  explicit StagedFolder(const std::string& final_folder);
  ~StagedFolder();  // without Commit: removes what was staged
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  std::string File(const std::string& name) const { return (staging_ / name).string(); }
  void Commit();

 private:
  std::filesystem::path final_, staging_;
  bool made_ = false;  // the final folder
};

}  // namespace evit::simulation
