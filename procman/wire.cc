#include "procman/wire.h"

#include "common/bus/wire_layout.h"

namespace evit::procman {

template <typename Message>
bool DecodeProcman(const std::uint8_t* data, std::size_t size, Message* message, std::string* why) {
  return CheckWire(LayoutOf<Message>(), Message::getHash(), data, size, why) &&
         message->decode(data, 0, static_cast<int>(size)) == static_cast<int>(size);
}

// NOLINTBEGIN(bugprone-macro-parentheses): the argument is a type
#define EVIT_INSTANTIATE(MESSAGE) \
  template bool DecodeProcman(const std::uint8_t*, std::size_t, procman_lcm::MESSAGE*, std::string*);
// NOLINTEND(bugprone-macro-parentheses)
PROCMAN_LCM_MESSAGES(EVIT_INSTANTIATE)
#undef EVIT_INSTANTIATE

}  // namespace evit::procman
