// Every message from the bus: its fingerprint says which one.
#include "common/bus/codec.h"
#include "common/wire/event_decoder.h"
#include "common/wire/event_wire.h"
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
}

// The two ways to decode events accept the same bytes and give the same events.
void TryEvents(const std::uint8_t* data, std::size_t size) {
  evit::event_packet_t message;
  evit::EventPacket packet;
  const bool fine = evit::DecodeChecked(data, size, &message);
  if (evit::DecodeEvents(data, size, &packet) != fine) __builtin_trap();
  if (!fine) return;
  evit::EventArray events;
  evit::AppendEvents(message, &events);
  if (packet.events.t != events.t || packet.events.x != events.x || packet.events.y != events.y ||
      packet.events.p != events.p)
    __builtin_trap();
}

template <typename Message>
void TryProcman(const std::uint8_t* data, std::size_t size) {
  Message message;
  std::string why;
  if (evit::procman::DecodeProcman(data, size, &message, &why)) evit::procman::EncodeProcman(message);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
#define EVIT_TRY(MESSAGE) Try<evit::MESSAGE>(data, size);
  EVIT_MESSAGES(EVIT_TRY)
#undef EVIT_TRY
  TryEvents(data, size);
#define EVIT_TRY(MESSAGE) TryProcman<procman_lcm::MESSAGE>(data, size);
  PROCMAN_LCM_MESSAGES(EVIT_TRY)
#undef EVIT_TRY
  return 0;
}
