#include "tools/formats/vector/sequence_import.h"

#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/formats/vector/event_file_reader.h"
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
Trajectory ReadTruth(const SequenceImport& job, const std::string& path) {
  Trajectory truth = ReadTum(path);
  for (StampedPose& s : truth) s.pose = job.T_map_world * s.pose * job.rig.T_marker_body;
  return truth;
}

// The events of one file; all of them must lie on the sensor.
class VectorEvents : public EventSource {
 public:
  VectorEvents(const std::string& path, const Camera& camera) : path_(path), camera_(camera), file_(path) {}

  bool Read(EventArray* events) override {
    n_read_ += file_.Read(1'000'000, events);
    for (std::size_t k = 0; k < events->size(); ++k) {
      if (events->x[k] < camera_.width && events->y[k] < camera_.height) continue;
      throw std::runtime_error(path_ + ": an event lies at (" + std::to_string(events->x[k]) + ", " +
                               std::to_string(events->y[k]) + "), outside the rig file's camera of " +
                               std::to_string(camera_.width) + "x" + std::to_string(camera_.height));
    }
    return events->size() > 0;
  }
  double share() const override { return static_cast<double>(n_read_) / static_cast<double>(file_.size()); }
  std::string name() const override { return path_ + ": events/t"; }

 private:
  std::string path_;
  Camera camera_;
  EventFileReader file_;
  std::size_t n_read_ = 0;
};

}  // namespace

ImportSummary ImportSequence(const SequenceImport& job, const std::function<void(double)>& progress) {
  if (!fs::is_directory(job.folder)) throw std::runtime_error(job.folder + ": there is no such folder");
  const std::string base = (fs::path(job.folder) / job.name).string();
  if (!fs::exists(base + kEventSuffix)) FailUnknown(job);
  VectorEvents events(base + kEventSuffix, job.rig.camera);
  ImportStreams streams;
  streams.imu_name = base + "1.synced.imu.txt";
  streams.imu = ReadImuFile(streams.imu_name);
  const std::string truth_file = base + "1.synced.gt.txt";
  if (fs::exists(truth_file)) streams.truth = ReadTruth(job, truth_file);
  return ImportLog(job, &events, std::move(streams), progress);
}

}  // namespace evit::formats
