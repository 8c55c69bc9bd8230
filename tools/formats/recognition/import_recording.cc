#include "tools/formats/recognition/import_recording.h"

#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "common/alignment/clock_alignment.h"
#include "common/alignment/event_flow.h"
#include "tools/formats/hdf5/h5_recording.h"
#include "tools/formats/hdf5/h5_streams.h"
#include "tools/formats/recognition/recording_files.h"
#include "tools/formats/tables/stream_tables.h"

namespace evit::formats {
namespace {

constexpr char kNone[] = "none";  // of a file's name: without that stream

std::string After(const std::string& what) { return what.empty() ? "" : "; " + what; }

// The streams of another file: a table, HDF5, or a recording that has them.
ImportStreams StreamsOf(const std::string& given, bool imu, const StreamChoice& choice) {
  // A folder as EuRoC lays them out.
  std::string path = given;
  for (const char* inside : {"data.csv", imu ? "imu0/data.csv" : "state_groundtruth_estimate0/data.csv"}) {
    const std::filesystem::path file = std::filesystem::path(given) / inside;
    if (std::filesystem::is_directory(given) && std::filesystem::is_regular_file(file)) path = file.string();
  }
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
  if (imu && streams.imu.empty())
    throw std::runtime_error(path + ": holds no IMU samples that can be read" +
                             After(DropText(streams.dropped_imu, "IMU samples")));
  if (!imu && streams.truth.empty())
    throw std::runtime_error(path + ": holds no poses that can be read" +
                             After(DropText(streams.dropped_truth, "poses")));
  return streams;
}

// The first minute is enough, and all that is read.
Utime FindOffset(Recording* recording, const RecordingInfo& info, const ImportStreams& streams, Utime guess) {
  constexpr Utime kLongest = 60 * kMicrosPerSecond, kRange = 2 * kMicrosPerSecond;
  if (streams.imu.empty()) throw std::runtime_error("--align-clocks: there is no IMU; give --imu FILE");
  const std::unique_ptr<EventSource> events = recording->Events(info.width, info.height);
  EventFlow flow(info.width, info.height);
  EventArray piece;
  std::optional<Utime> begin;
  while (events->Read(&piece)) {
    if (!begin) begin = piece.t.front();
    flow.Add(piece);
    if (piece.t.back() - *begin > kLongest) break;
  }
  return AlignClocks(flow.samples(), streams.imu, guess, kRange).offset;
}

// Elsewhere a choice would not be looked at.
void RequireChoicesUsed(const RecordingImport& job) {
  for (const auto& [choice, file, option, has_topics] :
       {std::tuple(job.choice.imu, job.imu, "--imu-topic", &HasImuTopics),
        std::tuple(job.choice.truth, job.truth, "--truth-topic", &HasTruthTopics),
        std::tuple(job.choice.truth_frame, job.truth, "--truth-frame", &HasTruthTopics)}) {
    if (choice.empty()) continue;
    const std::string& source = file.empty() ? job.paths.front() : file;
    if (file != kNone && has_topics(source)) continue;
    std::string text = option;
    text.append(" ").append(choice).append(": ");
    if (file == kNone) throw std::runtime_error(text.append("nothing is taken; leave the option out"));
    text.append(source).append(" has no topics to choose from; leave the option out");
    throw std::runtime_error(text);
  }
}

}  // namespace

ImportSummary ImportRecording(const RecordingImport& given,
                              const std::function<void(const RecordingInfo&, SE3*)>& found,
                              const std::function<void(double)>& progress) {
  RecordingImport job = given;
  const bool folder = job.paths.size() == 1 && std::filesystem::is_directory(job.paths.front());
  if (folder || job.paths.size() > 1) {
    const RecordingFiles files = folder ? FindRecording(job.paths.front(), job.imu, job.truth)
                                        : SortRecording(job.paths, job.imu, job.truth);
    job.paths = files.events;
    job.imu = files.imu;
    job.truth = files.truth;
  }
  RequireChoicesUsed(job);
  const StreamChoice choice = job.choice;  // each stream's is for the file that it comes from
  if (!job.imu.empty()) job.choice.imu.clear(), job.choice.take_imu = false;
  if (!job.truth.empty()) {
    job.choice.truth = job.choice.truth_frame = "";
    job.choice.take_truth = false;
  }
  const std::unique_ptr<Recording> recording = OpenRecording(job.paths, job.choice);
  RecordingInfo info = recording->info();
  if (job.width > 0) {
    info.width = job.width;
    info.height = job.height;
  }
  if (info.width == 0) {
    MeasureSize(recording.get(), &info.width, &info.height);
    info.measured = true;
  }
  found(info, &job.T_marker_body);
  ImportStreams streams = recording->Streams();
  if (job.imu == kNone) {
    streams.imu.clear();
    streams.imu_name.clear();
  } else if (!job.imu.empty()) {
    ImportStreams other = StreamsOf(job.imu, true, {"", choice.imu, "", "", false, true, false});
    streams.imu = std::move(other.imu);
    streams.imu_name = job.imu;
    streams.dropped_imu = other.dropped_imu;
  }
  if (job.truth == kNone) {
    streams.truth.clear();
  } else if (!job.truth.empty()) {
    ImportStreams other =
        StreamsOf(job.truth, false, {"", "", choice.truth, choice.truth_frame, false, false, true});
    streams.truth_name = job.truth;
    streams.truth = std::move(other.truth);
    streams.dropped_truth = other.dropped_truth;
  }
  if (job.imu_offset != 0 && streams.imu.empty())
    throw std::runtime_error("--imu-offset: there is no IMU; give --imu FILE");
  Utime imu_offset = std::llround(1e6 * job.imu_offset);
  if (job.align_clocks) imu_offset = FindOffset(recording.get(), info, streams, imu_offset);
  for (ImuSample& s : streams.imu) s.t += imu_offset;
  for (StampedPose& s : streams.truth) s.pose = job.T_map_world * s.pose * job.T_marker_body;
  const std::unique_ptr<EventSource> events = recording->Events(info.width, info.height);
  ImportSummary summary = ImportLog(job, events.get(), std::move(streams), progress);
  summary.imu_offset = imu_offset;
  return summary;
}

}  // namespace evit::formats
