#include "tools/formats/recognition/recording_folder.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tools/formats/hdf5/h5_recording.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr int kDepth = 2;  // folders in folders
constexpr std::size_t kMaxFiles = 10'000;

std::vector<fs::path> FilesBelow(const std::string& folder) {
  std::vector<fs::path> files;
  for (auto at = fs::recursive_directory_iterator(folder); at != fs::recursive_directory_iterator(); ++at) {
    if (at.depth() >= kDepth) at.disable_recursion_pending();
    if (at->is_regular_file()) files.push_back(at->path());
    if (files.size() > kMaxFiles)
      throw std::runtime_error(folder + ": holds too many files to look through; name the recording's");
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool Contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

bool IsText(const fs::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".txt" || extension == ".csv" || extension == ".tum";
}

std::string OnlyOne(const std::vector<std::string>& files, const std::string& folder, const char* what,
                    const char* option) {
  if (files.size() <= 1) return files.empty() ? "" : files.front();
  std::string list;
  for (const std::string& file : files) list += (list.empty() ? "" : ", ") + file;
  throw std::runtime_error(folder + ": several files may be " + what + "; choose with " + option + ": " +
                           list);
}

}  // namespace

RecordingFiles FindRecording(const std::string& folder, const std::string& given_imu,
                             const std::string& given_truth) {
  RecordingFiles found;
  std::vector<std::string> events, beside, imu, truth, text_events;
  for (const fs::path& file : FilesBelow(folder)) {
    const std::string name = file.filename().string(), path = file.string();
    if (Contains(path.substr(folder.size()), "right")) continue;
    if (IsText(file)) {
      if (name == "events.txt")
        text_events.push_back(path);
      else if (Contains(name, "truth") || Contains(name, "mocap") || Contains(name, ".gt."))
        truth.push_back(path);
      else if (Contains(name, "imu"))
        imu.push_back(path);
    } else if (H5Recording::Recognises(path)) {
      const H5File h5(path);
      if (!FindEvents(h5).empty()) {
        events.push_back(path);
      } else {
        ImportStreams streams;
        ReadH5Streams(h5, &streams);
        if (!streams.imu.empty() || !streams.truth.empty()) beside.push_back(path);
      }
    }
  }
  if (events.empty()) events = text_events;
  if (events.empty())
    throw std::runtime_error(folder + ": holds no events (HDF5 with events, events.txt, or a ROS 2 bag)");
  found.events = {OnlyOne(events, folder, "events", "FILE instead of the folder")};
  found.events.insert(found.events.end(), beside.begin(), beside.end());
  found.imu = given_imu.empty() ? OnlyOne(imu, folder, "the IMU's", "--imu") : given_imu;
  found.truth = given_truth.empty() ? OnlyOne(truth, folder, "the truth", "--truth") : given_truth;
  return found;
}

}  // namespace evit::formats
