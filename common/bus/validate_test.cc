#include "common/bus/validate.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/helpers/sample_map_messages.h"

namespace evit {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The sample is valid; changed by `change` it is refused, by decoding too, and the reason names `field`.
template <typename Message>
void ExpectRefused(const char* field, const std::function<void(Message*)>& change) {
  Message m = Sample<Message>();
  std::string why;
  ASSERT_TRUE(Validate(m, &why)) << why;
  change(&m);
  std::vector<std::uint8_t> bytes;
  EncodeTo(m, &bytes);
  Message out;
  EXPECT_FALSE(DecodeChecked(bytes.data(), bytes.size(), &out, &why)) << field;
  EXPECT_NE(why.find(field), std::string::npos) << why;
}

TEST(Validate, RefusesStampsAndNumbersOutOfRange) {
  ExpectRefused<stream_end_t>("utime", [](auto* m) { m->utime = std::numeric_limits<std::int64_t>::min(); });
  ExpectRefused<stream_end_t>("seq", [](auto* m) { m->seq = -1; });
  ExpectRefused<stream_end_t>("number of messages", [](auto* m) { m->n_imu_messages = -1; });
}

TEST(Validate, RefusesABodyPoseThatIsNone) {
  ExpectRefused<body_pose_t>("position", [](auto* m) { m->position[2] = kNaN; });
  ExpectRefused<body_pose_t>("velocity", [](auto* m) { m->velocity[0] = kInfinity; });
  ExpectRefused<body_pose_t>("orientation", [](auto* m) { m->orientation[3] = kNaN; });
  ExpectRefused<body_pose_t>("orientation", [](auto* m) { m->orientation[3] = 0.71; });
}

TEST(Validate, RefusesEventsUnsortedOrBelowZero) {
  ExpectRefused<event_packet_t>("dt_us[0]", [](auto* m) { m->dt_us[0] = -1; });
  ExpectRefused<event_packet_t>("dt_us", [](auto* m) { m->dt_us[4] = 0; });
  ExpectRefused<event_packet_t>("coordinate", [](auto* m) { m->x[2] = -1; });
  ExpectRefused<event_packet_t>("coordinate", [](auto* m) { m->y[4] = -480; });
  ExpectRefused<event_packet_t>("polarity", [](auto* m) { m->polarity[3] = 2; });
}

TEST(Validate, RefusesImuSamplesUnsortedOrNotFinite) {
  ExpectRefused<imu_batch_t>("sample_utime", [](auto* m) { m->sample_utime[3] = m->sample_utime[2]; });
  ExpectRefused<imu_batch_t>("utime", [](auto* m) { m->utime -= 1; });
  ExpectRefused<imu_batch_t>("gyro", [](auto* m) { m->gyro[1][2] = kNaN; });
  ExpectRefused<imu_batch_t>("accel", [](auto* m) { m->accel[4][0] = kInfinity; });
}

TEST(Validate, RefusesAKeyframeThatContradictsItself) {
  ExpectRefused<keyframe_t>("surface_size", [](auto* m) { m->width += 1; });
  ExpectRefused<keyframe_t>("width", [](auto* m) { m->width = -m->width, m->height = -m->height; });
  ExpectRefused<keyframe_t>("previous_utime", [](auto* m) { m->previous_utime = m->utime + 1; });
  ExpectRefused<keyframe_t>("imu_utime", [](auto* m) { m->imu_utime.back() = m->utime + 1; });
  ExpectRefused<keyframe_t>("imu_utime", [](auto* m) { m->imu_utime[1] = m->imu_utime[0]; });
  ExpectRefused<keyframe_t>("decay_us", [](auto* m) { m->decay_us = 0; });
  ExpectRefused<keyframe_t>("encoding", [](auto* m) { m->encoding = 2; });
  ExpectRefused<keyframe_t>("from_utime", [](auto* m) { m->from_utime = m->utime + 1; });
}

TEST(Validate, RefusesViewsWithoutSizeOrDepth) {
  ExpectRefused<map_view_t>("size", [](auto* m) { m->width += 1; });
  ExpectRefused<map_view_t>("width", [](auto* m) { m->width = -m->width, m->height = -m->height; });
  ExpectRefused<map_view_t>("min_depth", [](auto* m) { m->min_depth = 0; });
  ExpectRefused<map_view_t>("query_seq", [](auto* m) { m->query_seq = -1; });
  ExpectRefused<view_query_t>("distortion", [](auto* m) { m->camera.distortion[3] = 0.1; });
  ExpectRefused<view_query_t>("position", [](auto* m) { m->position[0] = kNaN; });
  ExpectRefused<view_query_t>("focal", [](auto* m) { m->camera.fy = 0; });
  ExpectRefused<view_query_t>("min_depth", [](auto* m) { m->max_depth = m->min_depth; });
  ExpectRefused<view_query_t>("min_depth", [](auto* m) { m->min_depth = 0; });
}

TEST(Validate, RefusesMapQueriesAndAnswersThatCannotBe) {
  ExpectRefused<map_points_t>("y", [](auto* m) { m->y[1] = std::numeric_limits<float>::quiet_NaN(); });
  ExpectRefused<map_points_t>("id", [](auto* m) { m->id[0] = 1000; });
  ExpectRefused<map_points_t>("n_visible", [](auto* m) { m->n_visible = 1; });
  ExpectRefused<map_query_t>("model", [](auto* m) { m->camera.model = "fisheye"; });
  ExpectRefused<map_query_t>("width", [](auto* m) { m->camera.width = 0; });
  ExpectRefused<map_query_t>("focal", [](auto* m) { m->camera.fx = 0; });
  ExpectRefused<map_query_t>("fy", [](auto* m) { m->camera.fy = kNaN; });
  ExpectRefused<map_query_t>("depth", [](auto* m) { m->max_depth = m->min_depth; });
  ExpectRefused<map_query_t>("max_points", [](auto* m) { m->max_points = -1; });
}

TEST(Validate, RefusesTrackerMessagesOutOfRange) {
  ExpectRefused<tracker_mode_t>("mode", [](auto* m) { m->mode = 3; });
  ExpectRefused<tracker_mode_t>("resend", [](auto* m) { m->resend = 2; });
  ExpectRefused<tracker_mode_t>("keyframe_seq", [](auto* m) { m->keyframe_seq = -2; });
  ExpectRefused<tracker_mode_t>("keyframe_stride", [](auto* m) { m->keyframe_stride = 0; });
  ExpectRefused<tracker_mode_t>("useful_interval_us", [](auto* m) { m->useful_interval_us = -1; });
  ExpectRefused<tracker_mode_t>("useful_interval_us", [](auto* m) { m->useful_interval_us = 1'000'001; });
  ExpectRefused<tracker_mode_t>("keyframe_stride", [](auto* m) { m->keyframe_stride = kNaN; });
  ExpectRefused<keyframe_t>("lookahead_us", [](auto* m) { m->lookahead_us = -1; });
  ExpectRefused<tracker_mode_t>("image_speed", [](auto* m) { m->image_speed = kNaN; });
  ExpectRefused<window_state_t>("mode", [](auto* m) { m->mode = -1; });
  ExpectRefused<window_state_t>("nodes", [](auto* m) { m->node[2].utime = m->node[1].utime; });
  ExpectRefused<window_state_t>("orientation", [](auto* m) { m->node[4].orientation[0] = 1; });
  ExpectRefused<window_state_t>("covariance", [](auto* m) { m->covariance[0][5] = kNaN; });
  ExpectRefused<window_state_t>("inlier_share", [](auto* m) { m->inlier_share = 1.01; });
}

TEST(Validate, RefusesControlAndStatusOutOfRange) {
  ExpectRefused<replay_control_t>("command", [](auto* m) { m->command = 4; });
  ExpectRefused<replay_control_t>("speed", [](auto* m) { m->speed = -1; });
  ExpectRefused<replay_control_t>("speed", [](auto* m) { m->speed = kNaN; });
  ExpectRefused<credit_t>("consumer", [](auto* m) { m->consumer.clear(); });
  ExpectRefused<credit_t>("next", [](auto* m) { m->next_events_seq = -2; });
  ExpectRefused<service_status_t>("progress", [](auto* m) { m->progress = 1.5; });
  ExpectRefused<service_status_t>("state", [](auto* m) { m->state.clear(); });
  ExpectRefused<service_status_t>("timing_ms", [](auto* m) { m->timing_ms[0] = kNaN; });
}

}  // namespace
}  // namespace evit
