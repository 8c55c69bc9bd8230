#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "evit/keyframe_t.hpp"
#include "evit/service_status_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "tools/monitor/foxglove.pb.h"
#include "tools/monitor/map_store.h"

namespace evit::monitor {

/// What a Foxglove viewer can subscribe to; the number is the channel's id.
enum class FoxgloveChannel : std::uint32_t { kPose = 1, kTransform, kTruth, kMap, kSurface, kLog };

/// {"op": "advertise"} for all channels, with the schemas as protobuf file descriptors.
std::string FoxgloveAdvertisement();
/// {"op": "serverInfo"}. `session`: another one, and viewers forget what they had.
std::string FoxgloveServerInfo(const std::string& session);

/// Frames "map" and "body"; stamps are the sensor's, us.
foxglove::PoseInFrame ToFoxglovePose(std::int64_t utime, const SE3& T_map_body);
foxglove::FrameTransform ToFoxgloveTransform(std::int64_t utime, const SE3& T_map_body);
/// x, y, z as floats, m, frame "map".
foxglove::PointCloud ToFoxgloveMap(std::int64_t utime, const MapStore& map);
/// "mono8", frame "camera".
foxglove::RawImage ToFoxgloveImage(const keyframe_t& keyframe);
foxglove::Log ToFoxgloveLog(std::int64_t utime, const tracker_mode_t& mode);
foxglove::Log ToFoxgloveLog(std::int64_t utime, const service_status_t& status);

}  // namespace evit::monitor
