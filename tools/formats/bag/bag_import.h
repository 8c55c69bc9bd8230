#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "tools/formats/import/import_log.h"

namespace evit::formats {

/// A recording in one or several ROS 1 bags, to become an LCM log: dvs_msgs or prophesee_event_msgs
/// EventArray, sensor_msgs/Imu and, where there is one, a topic of kTruthTypes as ground truth.
struct BagImport : ImportTarget {
  std::vector<std::string> files;
  Rig rig;  // its camera's size bounds the events; T_marker_body turns the truth's body into the IMU's
  std::string events_topic, imu_topic, truth_topic;  // empty: the only one of its type
};

/// As ImportLog. Times are those in the messages, not of their recording. What is out of order, not finite or
/// outside the sensor is counted and left out.
ImportSummary ImportBag(const BagImport& job, const std::function<void(double)>& progress);

}  // namespace evit::formats
