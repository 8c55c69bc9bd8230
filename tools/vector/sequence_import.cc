#include "tools/vector/sequence_import.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

#include "tools/vector/event_file.h"
#include "tools/vector/imu_file.h"
#include "tools/vector/stream_writer.h"

namespace evit {
namespace {

namespace fs = std::filesystem;

constexpr char kEventSuffix[] = "1.synced.left_event.hdf5";

// Removes a half-written file unless everything went well.
struct PartFile {
  std::string path;
  bool kept = false;
  ~PartFile() {
    if (!kept) std::remove(path.c_str());
  }
};

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

template <typename List>
void Clip(List* list, Utime begin, Utime end) {
  list->erase(
      std::remove_if(list->begin(), list->end(), [&](const auto& s) { return s.t < begin || s.t > end; }),
      list->end());
}

}  // namespace

ImportSummary ImportSequence(const SequenceImport& job, const std::function<void(double)>& progress) {
  if (!fs::is_directory(job.folder)) throw std::runtime_error(job.folder + ": there is no such folder");
  const std::string base = (fs::path(job.folder) / job.name).string();
  if (!fs::exists(base + kEventSuffix)) FailUnknown(job);
  EventFileReader events(base + kEventSuffix);
  std::vector<ImuSample> imu = ReadImuFile(base + "1.synced.imu.txt");
  Trajectory truth;
  const std::string truth_file = base + "1.synced.gt.txt";
  if (fs::exists(truth_file)) truth = ReadTruth(job, truth_file);

  EventArray piece;
  std::size_t n_read = events.Read(1'000'000, &piece);
  if (n_read == 0) throw std::runtime_error(base + kEventSuffix + ": events/t: holds no event");
  Utime begin = std::min(piece.t.front(), imu.front().t), end = std::numeric_limits<Utime>::max();
  if (job.seconds) {
    const Utime first = piece.t.front();
    begin = first + static_cast<Utime>(job.seconds->first * 1e6);
    end = first + static_cast<Utime>(job.seconds->second * 1e6);
  }
  if (imu.back().t < piece.t.front()) {
    throw std::runtime_error(
        base + "1.synced.imu.txt: ends before the first event: the files are not of one sequence");
  }
  Clip(&imu, begin, end);
  Clip(&truth, begin, end);
  if (imu.size() < 2) throw std::runtime_error("the part asked for by --seconds holds no IMU samples");

  const std::string out = job.out, truth_out = out + ".truth.tum";
  PartFile part{out + ".part"};
  ImportSummary summary;
  Utime last = begin;
  {
    StreamWriter writer(part.path, begin, imu, truth);
    for (bool more = true; more && n_read > 0; n_read = events.Read(1'000'000, &piece)) {
      for (std::size_t k = 0; k < piece.size(); ++k) {
        const Utime t = piece.t[k];
        if (t < begin) continue;
        if (t > end) {
          more = false;
          break;
        }
        if (piece.x[k] >= job.rig.camera.width || piece.y[k] >= job.rig.camera.height) {
          throw std::runtime_error(
              base + kEventSuffix + ": an event lies at (" + std::to_string(piece.x[k]) + ", " +
              std::to_string(piece.y[k]) + "), outside the rig file's camera of " +
              std::to_string(job.rig.camera.width) + "x" + std::to_string(job.rig.camera.height));
        }
        writer.AddEvent(t, piece.x[k], piece.y[k], piece.p[k]);
        ++summary.n_events;
        last = t;
      }
      progress(job.seconds ? static_cast<double>(last - begin) / static_cast<double>(end - begin)
                           : static_cast<double>(summary.n_events) / static_cast<double>(events.size()));
    }
    if (summary.n_events == 0) throw std::runtime_error("the part asked for by --seconds holds no events");
    writer.Close(std::max(last, imu.back().t));
    summary.n_packets = writer.n_packets();
  }
  // Truth of an earlier import must not stay beside a log that has none.
  if (truth.empty()) {
    std::remove(truth_out.c_str());
  } else {
    WriteTum(truth_out, truth);
  }
  if (std::rename(part.path.c_str(), out.c_str()) != 0) {
    std::remove(truth_out.c_str());
    throw std::runtime_error(out + ": cannot be written");
  }
  part.kept = true;
  summary.n_imu = static_cast<std::int64_t>(imu.size());
  summary.n_truth = static_cast<std::int64_t>(truth.size());
  summary.seconds = ToSeconds(last - begin);
  progress(1);
  return summary;
}

}  // namespace evit
