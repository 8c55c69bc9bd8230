#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/helpers/paths.h"
#include "tools/paper/paper_results.h"

namespace evit {

/// A folder of its own for each test, removed with this.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / (name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return *this / name;
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// The configuration shipped, loaded.
inline paper::Paper ShippedPaper() { return paper::LoadPaper(test::SourcePath("config/paper.textproto")); }

/// A run with the same error under every alignment: `reached` milestones, the k-th with k cm more than the
/// first.
inline paper::RunScore MadeUpRun(double position_cm, double orientation_deg, int reached) {
  paper::RunScore run;
  for (auto& row : run.ate) {
    for (int m = 0; m < reached; ++m) row[m] = paper::Ate{position_cm + m, orientation_deg};
  }
  run.keyframe_rate_hz = 50;
  run.cpu_s_per_s = 0.5;
  return run;
}

}  // namespace evit
