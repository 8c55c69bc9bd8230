#pragma once

#include <string>

#include "common/bus/codec.h"

/// The meaning of fields, once a message is decoded: finite numbers, unit quaternions (within 1e-3), sorted
/// times, sizes that agree, enumerations within their range. False, with the reason in `why` (may be null),
/// where it is wrong.
namespace evit {

bool Validate(const body_pose_t& m, std::string* why);
bool Validate(const credit_t& m, std::string* why);
bool Validate(const event_packet_t& m, std::string* why);
bool Validate(const imu_batch_t& m, std::string* why);
bool Validate(const keyframe_t& m, std::string* why);
bool Validate(const map_points_t& m, std::string* why);
bool Validate(const map_query_t& m, std::string* why);
bool Validate(const map_view_t& m, std::string* why);
bool Validate(const replay_control_t& m, std::string* why);
bool Validate(const service_status_t& m, std::string* why);
bool Validate(const stream_end_t& m, std::string* why);
bool Validate(const tracker_mode_t& m, std::string* why);
bool Validate(const view_query_t& m, std::string* why);
bool Validate(const window_state_t& m, std::string* why);

}  // namespace evit
