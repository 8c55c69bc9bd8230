#include "tools/formats/recognition/import_recording.h"

#include <utility>

namespace evit::formats {

ImportSummary ImportRecording(const RecordingImport& job,
                              const std::function<void(const RecordingInfo&)>& found,
                              const std::function<void(double)>& progress) {
  const std::unique_ptr<Recording> recording = OpenRecording(job.paths, job.choice);
  RecordingInfo info = recording->info();
  if (job.width > 0) {
    info.width = job.width;
    info.height = job.height;
  }
  if (info.width == 0) MeasureSize(recording.get(), &info.width, &info.height);
  found(info);
  ImportStreams streams = recording->Streams();
  for (StampedPose& s : streams.truth) s.pose = job.T_map_world * s.pose * job.T_marker_body;
  const std::unique_ptr<EventSource> events = recording->Events(info.width, info.height);
  return ImportLog(job, events.get(), std::move(streams), progress);
}

}  // namespace evit::formats
