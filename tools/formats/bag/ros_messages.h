#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/imu/imu_sample.h"
#include "tools/formats/import/event_filter.h"

namespace evit::formats {

/// Serialized ROS 1 messages, decoded without ROS's generated code. ROS's nanoseconds are rounded to
/// microseconds. Lengths are checked before anything is reserved; all throw std::runtime_error saying which
/// field is wrong.

inline constexpr const char* kEventTypes[] = {"dvs_msgs/EventArray", "prophesee_event_msgs/EventArray"};
inline constexpr const char* kImuTypes[] = {"sensor_msgs/Imu"};
/// In the order they are preferred: an Odometry is more often somebody's estimate.
inline constexpr const char* kTruthTypes[] = {"geometry_msgs/PoseStamped", "geometry_msgs/TransformStamped",
                                              "geometry_msgs/PoseWithCovarianceStamped", "nav_msgs/Odometry"};

/// Appends the events that pass the filter.
void DecodeEventArray(const std::uint8_t* data, std::size_t size, EventFilter* filter, EventArray* events);

ImuSample DecodeImu(const std::uint8_t* data, std::size_t size);

/// A message of one of kTruthTypes: the pose of its child or its own. The quaternion as it stands, of
/// whatever length.
StampedPose DecodePose(const std::string& type, const std::uint8_t* data, std::size_t size);

}  // namespace evit::formats
