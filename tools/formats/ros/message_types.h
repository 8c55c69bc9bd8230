#pragma once

#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/imu/imu_sample.h"
#include "tools/formats/event_packet/event_packet_decoder.h"
#include "tools/formats/ros/ros_cursor.h"

namespace evit::formats {

/// The messages of ROS that a recording is made of; types as ROS 1 writes them. All throw as RosCursor does.
inline constexpr const char* kEventArrayTypes[] = {"dvs_msgs/EventArray", "prophesee_event_msgs/EventArray"};
inline constexpr const char* kEventPacketTypes[] = {"event_camera_msgs/EventPacket",
                                                    "event_array_msgs/EventArray"};
inline constexpr const char* kImuType = "sensor_msgs/Imu";
inline constexpr const char* kPoseTypes[] = {"geometry_msgs/PoseStamped",
                                             "geometry_msgs/PoseWithCovarianceStamped", "nav_msgs/Odometry",
                                             "geometry_msgs/TransformStamped"};
/// Of many frames at a time (TransformPoses).
inline constexpr const char* kTransformsTypes[] = {"tf2_msgs/TFMessage", "tf/tfMessage"};

struct SensorSizeInMessage {
  std::uint32_t width = 0, height = 0;
};

/// Appends the events; their sensor's size comes back.
SensorSizeInMessage GetEventArray(RosCursor message, EventArray* events);
EventPacket GetEventPacket(RosCursor message);
ImuSample GetImu(RosCursor* message);
/// Up to the pose itself. The quaternion as it stands, of whatever length.
StampedPose GetPose(const std::string& type, RosCursor* message);

}  // namespace evit::formats
