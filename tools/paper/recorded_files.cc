#include "tools/paper/recorded_files.h"

#include <filesystem>
#include <stdexcept>

namespace evit::paper {
namespace {

namespace fs = std::filesystem;

std::string FindMap(const std::string& folder, const paper::Sequence& sequence) {
  if (sequence.has_map()) {
    const std::string path = (fs::path(folder) / sequence.map()).string();
    if (fs::exists(path)) return path;
    throw std::runtime_error(path + ": there is no such map; see `map` of sequence " + sequence.name() +
                             " in the configuration");
  }
  for (const char* end : {".pcd", ".ply", ".txt"}) {
    const std::string path = (fs::path(folder) / (sequence.scene() + end)).string();
    if (fs::exists(path)) return path;
  }
  return "";
}

// What a map can be made of: pictures beside the events, as VECtor's files are named.
void RequirePictures(const std::string& folder, const paper::Sequence& sequence, RecordedFiles* files) {
  const fs::path place =
      files->folder.empty() ? fs::path(files->bags.front()).parent_path() : fs::path(files->folder);
  const std::string base = (place / (sequence.name() + "1.synced.left_camera")).string();
  for (const std::string& path : {(place / "left_camera").string(), base}) {
    for (const char* end : {".bag", "", ".zip"}) {
      if (fs::exists(path + end)) files->pictures = path + end;
    }
  }
  if (!files->pictures.empty()) return;
  throw std::runtime_error(
      folder + ": holds " + sequence.name() + " but no map of its scene: " + sequence.scene() +
      ".pcd, .ply or .txt is expected (z up, metres), or `map` in the configuration, or the "
      "left regular camera's pictures to make one of, in " +
      base + "/, .zip or .bag");
}

std::string FindPhotometricMap(const std::string& folder, const paper::Sequence& sequence) {
  const std::string name =
      sequence.has_photometric_map() ? sequence.photometric_map() : sequence.scene() + "_photometric.ply";
  const std::string path = (fs::path(folder) / name).string();
  if (fs::exists(path)) return path;
  if (!sequence.has_photometric_map()) return "";
  throw std::runtime_error(path + ": there is no such map; see `photometric_map` of sequence " +
                           sequence.name() + " in the configuration");
}

std::vector<std::string> FindBags(const fs::path& folder, const std::string& name) {
  const auto bag = [&](const std::string& end) { return (folder / (name + end + ".bag")).string(); };
  for (const char* stem : {"1.synced.", "1."}) {
    const std::string events = bag(std::string(stem) + "left_event");
    if (!fs::exists(events)) continue;
    std::vector<std::string> bags{events};
    for (const char* other : {"imu", "gt"}) {
      const std::string path = bag(std::string(stem) + other);
      if (fs::exists(path)) bags.push_back(path);
    }
    return bags;
  }
  for (const char* end : {"", "1", "1.synced"}) {
    if (fs::exists(bag(end))) return {bag(end)};
  }
  return {};
}

}  // namespace

std::optional<RecordedFiles> FindRecorded(const std::string& folder, const paper::Sequence& sequence) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder + ": there is no such folder");
  RecordedFiles files;
  for (const std::string& bag : sequence.bag()) {
    files.bags.push_back((fs::path(folder) / bag).string());
    if (!fs::exists(files.bags.back())) {
      throw std::runtime_error(files.bags.back() + ": there is no such bag; see `bag` of sequence " +
                               sequence.name() + " in the configuration");
    }
  }
  for (const fs::path& place : {fs::path(folder), fs::path(folder) / sequence.name()}) {
    if (!files.bags.empty()) break;
    const std::string base = (place / (sequence.name() + "1.synced.")).string();
    if (fs::exists(base + "left_event.hdf5")) {
      for (const char* other : {"imu.txt", "gt.txt"}) {
        if (!fs::exists(base + other))
          throw std::runtime_error(base + other + ": is missing beside the events; tables need it");
      }
      files.folder = place.string();
      break;
    }
    files.bags = FindBags(place, sequence.name());
  }
  if (files.folder.empty() && files.bags.empty()) return {};
  files.map = FindMap(folder, sequence);
  if (files.map.empty()) RequirePictures(folder, sequence, &files);
  files.photometric_map = FindPhotometricMap(folder, sequence);
  return files;
}

}  // namespace evit::paper
