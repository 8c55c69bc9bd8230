// How each message lies on the wire: the sizes of lcmtypes/*.lcm, in order. A new message is one line here.
#include "common/bus/codec.h"
#include "common/bus/limits.h"
#include "common/bus/wire_layout.h"

namespace evit {

namespace {

constexpr int kStamp = 3 * 8;  // utime, seq, epoch
constexpr int kVector = 3 * 8;
constexpr int kQuaternion = 4 * 8;
constexpr int kNode = 2 * 8 + kVector + kQuaternion + 3 * kVector;

}  // namespace

#define EVIT_LAYOUT(MESSAGE, ...)                 \
  template <>                                     \
  const WireLayout& LayoutOf<MESSAGE>() {         \
    static const WireLayout layout = __VA_ARGS__; \
    return layout;                                \
  }

EVIT_LAYOUT(body_pose_t, {Bytes(kStamp + 2 * kVector + kQuaternion)})
EVIT_LAYOUT(credit_t, {Bytes(kStamp), Text("consumer"), Bytes(3 * 8)})
EVIT_LAYOUT(event_packet_t, {Bytes(kStamp), Count("n", kMaxPacketEvents), Array(4 + 2 + 2 + 1, "n")})
EVIT_LAYOUT(imu_batch_t, {Bytes(kStamp), Count("n", kMaxImuSamples), Array(8 + 2 * kVector, "n")})
EVIT_LAYOUT(keyframe_t,
            {Bytes(kStamp + 8 + 1 + 4 + 2 * 8 + 2 * 4 + 1 + 8), Count("surface_size", kMaxSurfaceSize),
             Array(1, "surface_size"), Count("n_imu", kMaxImuSamples), Array(8 + 2 * kVector, "n_imu"), Bytes(4)})
EVIT_LAYOUT(map_points_t, {Bytes(kStamp + 3 * 8 + 4), Count("n", kMaxMapPoints), Array(3 * 4 + 4, "n")})
EVIT_LAYOUT(map_query_t, {Bytes(kStamp + kVector + kQuaternion), Text("camera.model"),
                          Bytes(2 * 4 + 4 * 8 + 5 * 8 + 3 * 8 + 1 + 4 + 8)})
EVIT_LAYOUT(map_view_t,
            {Bytes(kStamp + 2 * 8 + 2 * 4), Count("size", kMaxSurfaceSize), Bytes(8), Array(2 + 2, "size")})
EVIT_LAYOUT(replay_control_t, {Bytes(kStamp + 1 + 8 + 8)})
EVIT_LAYOUT(service_status_t, {Bytes(kStamp), Text("service"), Text("state"), Text("detail"), Bytes(8 + 4),
                               Count("n_counters", kMaxStatusEntries), Text("counter_name", "n_counters"),
                               Array(8, "n_counters"), Count("n_timings", kMaxStatusEntries),
                               Text("timing_name", "n_timings"), Array(8, "n_timings")})
EVIT_LAYOUT(stream_end_t, {Bytes(kStamp + 2 * 8)})
EVIT_LAYOUT(tracker_mode_t, {Bytes(kStamp + 2 * 8 + 2), Text("reason"), Bytes(2 * 8)})
EVIT_LAYOUT(view_query_t, {Bytes(kStamp + kVector + kQuaternion), Text("camera.model"),
                           Bytes(2 * 4 + 4 * 8 + 5 * 8 + 2 * 8)})
EVIT_LAYOUT(window_state_t, {Bytes(kStamp + 8 + 1), Count("n_nodes", kMaxWindowNodes),
                             Array(kNode, "n_nodes"), Bytes(36 * 8 + 4 + 2 * 8 + 4 + 3 * 8)})

#undef EVIT_LAYOUT

}  // namespace evit
