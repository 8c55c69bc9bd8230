#include "tools/formats/vector/sequence_import.h"

#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/formats/hdf5/h5_recording.h"
#include "tools/formats/vector/imu_file.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr char kEventSuffix[] = "1.synced.left_event.hdf5";

[[noreturn]] void FailUnknown(const SequenceImport& job) {
  std::set<std::string> found;
  const std::string suffix = kEventSuffix;
  for (const auto& entry : fs::directory_iterator(job.folder)) {
    const std::string file = entry.path().filename().string();
    if (file.size() > suffix.size() &&
        file.compare(file.size() - suffix.size(), suffix.size(), suffix) == 0) {
      found.insert(file.substr(0, file.size() - suffix.size()));
    }
  }
  std::string list;
  for (const std::string& name : found) list += (list.empty() ? "" : ", ") + name;
  throw std::runtime_error(job.folder + ": there is no " + job.name + kEventSuffix +
                           "; sequences found there: " + (list.empty() ? "none" : list));
}

// Ground truth of the marker body becomes the IMU body's, in the map frame.
Trajectory ReadTruth(const SequenceImport& job, const std::string& path, DropCounts* dropped) {
  TumSkipped skipped;
  Trajectory truth = ReadTum(path, &skipped);
  dropped->late += skipped.rows;
  for (StampedPose& s : truth) s.pose = job.T_map_world * s.pose * job.rig.T_marker_body;
  return truth;
}

}  // namespace

ImportSummary ImportSequence(const SequenceImport& job, const std::function<void(double)>& progress) {
  if (!fs::is_directory(job.folder)) throw std::runtime_error(job.folder + ": there is no such folder");
  const std::string base = (fs::path(job.folder) / job.name).string();
  if (!fs::exists(base + kEventSuffix)) FailUnknown(job);
  H5Recording recording({base + kEventSuffix}, "events");
  const std::unique_ptr<EventSource> events = recording.Events(job.rig.camera.width, job.rig.camera.height);
  ImportStreams streams;
  streams.imu_name = base + "1.synced.imu.txt";
  streams.imu = ReadImuFile(streams.imu_name, &streams.dropped_imu);
  const std::string truth_file = base + "1.synced.gt.txt";
  if (fs::exists(truth_file)) streams.truth = ReadTruth(job, truth_file, &streams.dropped_truth);
  return ImportLog(job, events.get(), std::move(streams), progress);
}

}  // namespace evit::formats
