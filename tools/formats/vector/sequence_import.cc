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

std::set<std::string> SequencesIn(const std::string& folder) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder + ": there is no such folder");
  std::set<std::string> found;
  const std::string suffix = kEventSuffix;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file.size() > suffix.size() &&
        file.compare(file.size() - suffix.size(), suffix.size(), suffix) == 0) {
      found.insert(file.substr(0, file.size() - suffix.size()));
    }
  }
  return found;
}

std::string List(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
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

std::string OnlySequence(const std::string& folder) {
  const std::set<std::string> found = SequencesIn(folder);
  if (found.size() == 1) return *found.begin();
  if (found.empty())
    throw std::runtime_error(folder + ": holds no sequence of VECtor (NAME" + kEventSuffix +
                             "); other recordings: evit import DIR --out LOG");
  throw std::runtime_error(folder + ": holds several sequences; choose with --sequence: " + List(found));
}

ImportSummary ImportSequence(const SequenceImport& job, const std::function<void(double)>& progress) {
  const std::set<std::string> found = SequencesIn(job.folder);
  const std::string base = (fs::path(job.folder) / job.name).string();
  if (found.count(job.name) == 0) {
    throw std::runtime_error(job.folder + ": there is no " + job.name + kEventSuffix +
                             "; sequences found there: " + List(found));
  }
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
