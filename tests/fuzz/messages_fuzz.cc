// Every message from the bus. The first byte chooses its type.
#include "common/bus/codec.h"
#include "common/events/wire/event_wire.h"
#include "procman/wire.h"

namespace {

template <typename Message>
void Try(const std::uint8_t* data, std::size_t size) {
  Message message;
  std::string why;
  if (!evit::DecodeChecked(data, size, &message, &why)) return;
  std::vector<std::uint8_t> again;
  evit::EncodeTo(message, &again);
  if (again != std::vector<std::uint8_t>(data, data + size))
    __builtin_trap();  // not the bytes it was made from
  if constexpr (std::is_same_v<Message, evit::event_packet_t>) {
    evit::EventArray events;
    evit::AppendEvents(message, &events);
  }
}

template <typename Message>
void TryProcman(const std::uint8_t* data, std::size_t size) {
  Message message;
  std::string why;
  if (evit::procman::DecodeProcman(data, size, &message, &why)) evit::procman::EncodeProcman(message);
}

using Function = void (*)(const std::uint8_t*, std::size_t);
constexpr Function kTypes[] = {&Try<evit::body_pose_t>,
                               &Try<evit::credit_t>,
                               &Try<evit::event_packet_t>,
                               &Try<evit::imu_batch_t>,
                               &Try<evit::keyframe_t>,
                               &Try<evit::map_points_t>,
                               &Try<evit::map_query_t>,
                               &Try<evit::replay_control_t>,
                               &Try<evit::service_status_t>,
                               &Try<evit::stream_end_t>,
                               &Try<evit::tracker_mode_t>,
                               &Try<evit::window_state_t>,
                               &TryProcman<procman_lcm::orders_t>,
                               &TryProcman<procman_lcm::deputy_info_t>,
                               &TryProcman<procman_lcm::output_t>,
                               &TryProcman<procman_lcm::discovery_t>,
                               &Try<evit::map_view_t>,
                               &Try<evit::view_query_t>};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) kTypes[data[0] % std::size(kTypes)](data + 1, size - 1);
  return 0;
}
