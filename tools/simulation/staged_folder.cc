#include "tools/simulation/staged_folder.h"

#include <stdexcept>
#include <system_error>

namespace evit::simulation {

namespace {

namespace fs = std::filesystem;

}  // namespace

StagedFolder::StagedFolder(const std::string& final_folder) : final_(fs::absolute(final_folder)) {
  if (!final_.has_filename()) final_ = final_.parent_path();  // "a/" -> "a"
  std::error_code error;
  if (fs::exists(final_, error) && !fs::is_directory(final_, error)) {
    throw std::runtime_error("cannot write to " + final_.string() + ": it is a file, a folder is needed");
  }
  made_ = fs::create_directories(final_, error);
  staging_ = final_ / ".incomplete";
  if (!error) fs::remove_all(staging_, error);
  if (!error) fs::create_directory(staging_, error);
  if (error) throw std::runtime_error("cannot write to " + final_.string() + ": " + error.message());
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (made_) fs::remove(final_, ignored);  // does so only if empty: made for nothing
}

void StagedFolder::Commit() {
  for (const auto& entry : fs::directory_iterator(staging_)) {
    std::error_code error;
    if (entry.is_directory()) fs::remove_all(final_ / entry.path().filename(), error);  // of an earlier run
    fs::rename(entry.path(), final_ / entry.path().filename(), error);
    if (error) {
      throw std::runtime_error("cannot write " + (final_ / entry.path().filename()).string() + ": " +
                               error.message());
    }
  }
}

}  // namespace evit::simulation
