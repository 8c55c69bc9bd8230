#include "tools/formats/recognition/import_recording.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "tools/formats/hdf5/h5_recording.h"
#include "tools/formats/recognition/recording_folder.h"
#include "tools/formats/tables/stream_tables.h"

namespace evit::formats {
namespace {

// The streams of another file: a table, HDF5, or a recording that has them.
ImportStreams StreamsOf(const std::string& path, bool imu, const StreamChoice& choice) {
  if (!std::filesystem::exists(path)) throw std::runtime_error(path + ": there is no such file");
  ImportStreams streams;
  if (H5Recording::Recognises(path)) {
    ReadH5Streams(H5File(path), &streams);
  } else if (IsRecording(path)) {
    streams = OpenRecording({path}, choice)->Streams();
  } else if (imu) {
    streams.imu_name = path;
    streams.imu = ReadImuTable(path, &streams.dropped_imu);
  } else {
    streams.truth = ReadPoseTable(path, &streams.dropped_truth);
  }
  if (imu && streams.imu.empty()) throw std::runtime_error(path + ": holds no IMU samples that can be read");
  if (!imu && streams.truth.empty()) throw std::runtime_error(path + ": holds no poses that can be read");
  return streams;
}

}  // namespace

ImportSummary ImportRecording(const RecordingImport& given,
                              const std::function<void(const RecordingInfo&)>& found,
                              const std::function<void(double)>& progress) {
  RecordingImport job = given;
  if (job.paths.size() == 1 && std::filesystem::is_directory(job.paths.front()) &&
      !IsRecording(job.paths.front())) {
    const RecordingFiles files = FindRecording(job.paths.front());
    job.paths = files.events;
    if (job.imu.empty()) job.imu = files.imu;
    if (job.truth.empty()) job.truth = files.truth;
  }
  const std::unique_ptr<Recording> recording = OpenRecording(job.paths, job.choice);
  RecordingInfo info = recording->info();
  if (job.width > 0) {
    info.width = job.width;
    info.height = job.height;
  }
  if (info.width == 0) MeasureSize(recording.get(), &info.width, &info.height);
  found(info);
  ImportStreams streams = recording->Streams();
  if (!job.imu.empty()) {
    ImportStreams other = StreamsOf(job.imu, true, job.choice);
    streams.imu = std::move(other.imu);
    streams.imu_name = job.imu;
    streams.dropped_imu = other.dropped_imu;
  }
  if (!job.truth.empty()) {
    ImportStreams other = StreamsOf(job.truth, false, job.choice);
    streams.truth = std::move(other.truth);
    streams.dropped_truth = other.dropped_truth;
  }
  for (ImuSample& s : streams.imu) s.t += std::llround(1e6 * job.imu_offset);
  for (StampedPose& s : streams.truth) s.pose = job.T_map_world * s.pose * job.T_marker_body;
  const std::unique_ptr<EventSource> events = recording->Events(info.width, info.height);
  return ImportLog(job, events.get(), std::move(streams), progress);
}

}  // namespace evit::formats
