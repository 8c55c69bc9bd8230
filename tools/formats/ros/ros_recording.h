#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/formats/event_packet/clock_fit.h"
#include "tools/formats/import/recording.h"
#include "tools/formats/ros/message_store.h"
#include "tools/formats/ros/transform_poses.h"

namespace evit::formats {

/// Which topics to take; empty: the only one of its kind.
struct RosTopics {
  std::string events, imu, truth;
  std::string truth_frame;  // of a TFMessage: its child_frame_id; empty: the only one
  bool take_events = true, take_imu = true, take_truth = true;  // false: not looked at
};

/// A recording in a ROS bag, whatever its container: events (EventArray of dvs_msgs or prophesee_event_msgs,
/// EventPacket), sensor_msgs/Imu, and truth as pose, odometry or transform, also that of a frame of /tf where
/// its topic is named (many bags have one that is no truth). Times are those in the messages.
/// Events of an EventPacket that carry only the sensor's clock get the host's by the packets' stamps
/// (ClockFit): those of IMU and truth are the host's.
class RosRecording : public Recording {
 public:
  /// Throws std::runtime_error naming bag, topics and option: several to choose from. A bag without events
  /// may still have the other streams; Events() then throws.
  RosRecording(std::unique_ptr<MessageStore> store, const RosTopics& topics);

  RecordingInfo info() const override { return info_; }
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override;

 private:
  void Scan(const std::string& truth_frame);
  void NoteLoss(const MessagePass& pass, const RosTopic& topic, DropCounts* dropped) const;
  void TakeTruth(const TransformPoses& frames, const std::string& frame);

  std::unique_ptr<MessageStore> store_;
  RosTopic events_, imu_, truth_;  // without a name: none
  RecordingInfo info_;
  ClockFit clock_;
  bool own_clock_ = false;  // the events' time is the sensor's
  ImportStreams streams_;
};

}  // namespace evit::formats
