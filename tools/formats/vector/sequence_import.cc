#include "tools/formats/vector/sequence_import.h"

#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/formats/import/event_filter.h"
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
Trajectory ReadTruth(const SequenceImport& job, const std::string& path, DropCounts* dropped) {
  TumSkipped skipped;
  Trajectory truth = ReadTum(path, &skipped);
  dropped->late += skipped.rows;
  for (StampedPose& s : truth) s.pose = job.T_map_world * s.pose * job.rig.T_marker_body;
  return truth;
}

class VectorEvents : public EventSource {
 public:
  VectorEvents(const std::string& path, const Camera& camera)
      : path_(path), file_(path), filter_(camera.width, camera.height) {}

  bool Read(EventArray* events) override {
    events->clear();
    while (events->size() == 0) {
      const std::size_t n = file_.Read(1'000'000, &piece_);
      if (n == 0) return false;
      n_read_ += n;
      for (std::size_t k = 0; k < piece_.size(); ++k) {
        if (filter_.Keep(piece_.x[k], piece_.y[k]))
          events->push_back(piece_.t[k], piece_.x[k], piece_.y[k], piece_.p[k]);
      }
    }
    return true;
  }
  double share() const override { return static_cast<double>(n_read_) / static_cast<double>(file_.size()); }
  std::string name() const override { return path_ + ": events"; }
  DropCounts dropped() const override {
    DropCounts dropped = filter_.dropped();
    dropped.outside += file_.n_impossible();
    return dropped;
  }

 private:
  std::string path_;
  EventFileReader file_;
  EventFilter filter_;
  EventArray piece_;
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
  streams.imu = ReadImuFile(streams.imu_name, &streams.dropped_imu);
  const std::string truth_file = base + "1.synced.gt.txt";
  if (fs::exists(truth_file)) streams.truth = ReadTruth(job, truth_file, &streams.dropped_truth);
  return ImportLog(job, &events, std::move(streams), progress);
}

}  // namespace evit::formats
