// Every message from the bus: its fingerprint says which one.
#include "common/bus/codec.h"
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
#define EVIT_TRY(MESSAGE) Try<evit::MESSAGE>(data, size);
  EVIT_MESSAGES(EVIT_TRY)
#undef EVIT_TRY
#define EVIT_TRY(MESSAGE) TryProcman<procman_lcm::MESSAGE>(data, size);
  PROCMAN_LCM_MESSAGES(EVIT_TRY)
#undef EVIT_TRY
  return 0;
}
