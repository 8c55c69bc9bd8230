#include "common/bus/codec.h"

#include <stdexcept>

#include "common/bus/message_arrays.h"
#include "common/bus/validate.h"
#include "common/bus/wire_layout.h"

namespace evit {

template <typename Message>
bool DecodeChecked(const std::uint8_t* data, std::size_t size, Message* message, std::string* why) {
  if (!CheckWire(LayoutOf<Message>(), Message::getHash(), data, size, why)) return false;
  if (message->decode(data, 0, static_cast<int>(size)) != static_cast<int>(size)) {
    if (why != nullptr) *why = "the decoder refuses it";
    return false;
  }
  VisitArrays(*message, [](const char* /*name*/, std::int32_t count, auto& array) {
    array.resize(static_cast<std::size_t>(count));
  });
  return Validate(*message, why);
}

template <typename Message>
void EncodeTo(const Message& message, std::vector<std::uint8_t>* buffer) {
  VisitArrays(message, [](const char* name, std::int32_t count, const auto& array) {
    if (count >= 0 && array.size() == static_cast<std::size_t>(count)) return;
    throw std::logic_error(std::string(Message::getTypeName()) + "." + name + " has " +
                           std::to_string(array.size()) + " elements, its count says " +
                           std::to_string(count));
  });
  buffer->resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(buffer->data(), 0, static_cast<int>(buffer->size()));
}

// NOLINTBEGIN(bugprone-macro-parentheses): the argument is a type
#define EVIT_INSTANTIATE(MESSAGE)                                                                 \
  template bool DecodeChecked<MESSAGE>(const std::uint8_t*, std::size_t, MESSAGE*, std::string*); \
  template void EncodeTo<MESSAGE>(const MESSAGE&, std::vector<std::uint8_t>*);
// NOLINTEND(bugprone-macro-parentheses)

EVIT_INSTANTIATE(body_pose_t)
EVIT_INSTANTIATE(credit_t)
EVIT_INSTANTIATE(event_packet_t)
EVIT_INSTANTIATE(imu_batch_t)
EVIT_INSTANTIATE(keyframe_t)
EVIT_INSTANTIATE(map_points_t)
EVIT_INSTANTIATE(map_query_t)
EVIT_INSTANTIATE(map_view_t)
EVIT_INSTANTIATE(replay_control_t)
EVIT_INSTANTIATE(service_status_t)
EVIT_INSTANTIATE(stream_end_t)
EVIT_INSTANTIATE(tracker_mode_t)
EVIT_INSTANTIATE(view_query_t)
EVIT_INSTANTIATE(window_state_t)

#undef EVIT_INSTANTIATE

}  // namespace evit
