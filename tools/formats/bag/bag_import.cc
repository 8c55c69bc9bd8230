#include "tools/formats/bag/bag_import.h"

#include <stdexcept>
#include <utility>

#include "tools/formats/bag/bag_events.h"
#include "tools/formats/bag/ros_messages.h"
#include "tools/formats/ros/one_recording.h"

namespace evit::formats {
namespace {

// IMU and truth in one pass: they are often in one file with the events, which takes long to go through.
ImportStreams ReadStreams(const BagImport& job, const BagFiles& files, const std::string& imu_topic,
                          const std::string& truth_topic, const std::function<void(double)>& progress) {
  ImportStreams streams;
  streams.imu_name = files.Names() + ": " + imu_topic;
  BagReader reader(files, {imu_topic, truth_topic});
  const std::string truth_type = truth_topic.empty() ? "" : files.types().at(truth_topic);
  for (std::int64_t n = 0; reader.Next(); ++n) {
    if (n % 1000 == 0) progress(0);
    if (reader.topic() == imu_topic) {
      const ImuSample s = reader.Decoded(DecodeImu);
      AppendValid(s, s.gyro.allFinite() && s.accel.allFinite(), &streams.imu, &streams.dropped_imu);
    } else {
      const auto decode = [&](const std::uint8_t* data, std::size_t size) {
        return DecodePose(truth_type, data, size);
      };
      AppendPose(reader.Decoded(decode), true, &streams.truth, &streams.dropped_truth);
    }
  }
  for (StampedPose& s : streams.truth) s.pose = job.T_map_world * s.pose * job.rig.T_marker_body;
  return streams;
}

// The topic of the first type that there is.
std::string FindTruth(const BagImport& job, const BagFiles& files) {
  if (!job.truth_topic.empty()) return files.FindTopic(kTruthTypes, job.truth_topic, "--truth-topic");
  for (const char* type : kTruthTypes) {
    const char* const one[] = {type};
    const std::string topic = files.FindTopic(one, "", "--truth-topic");
    if (!topic.empty()) return topic;
  }
  return "";
}

std::string Required(const std::string& topic, const BagFiles& files, const char* what) {
  if (topic.empty()) {
    throw std::runtime_error(files.Names() + ": holds no " + what + "; topics: " + files.Topics() +
                             "; if another bag holds it, give that file too");
  }
  return topic;
}

}  // namespace

ImportSummary ImportBag(const BagImport& job, const std::function<void(double)>& progress) {
  const BagFiles files(job.files);
  const std::string events_topic =
      Required(files.FindTopic(kEventTypes, job.events_topic, "--events-topic"), files,
               "events (dvs_msgs/EventArray or prophesee_event_msgs/EventArray)");
  const std::string imu_topic =
      Required(files.FindTopic(kImuTypes, job.imu_topic, "--imu-topic"), files, "IMU (sensor_msgs/Imu)");
  const std::string truth_topic = FindTruth(job, files);
  RequireOneRecording(files.Parts(), {events_topic, imu_topic, truth_topic});
  ImportStreams streams = ReadStreams(job, files, imu_topic, truth_topic, progress);
  BagEvents events(files, events_topic, job.rig.camera.width, job.rig.camera.height);
  return ImportLog(job, &events, std::move(streams), progress);
}

}  // namespace evit::formats
