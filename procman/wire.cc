#include "procman/wire.h"

#include "common/bus/wire_layout.h"

namespace evit::procman {
namespace {

constexpr std::int32_t kMaxCommands = 1000;

WireLayout CommandWith(int more_bytes) {
  return {Text("command_id"), Text("exec_str"), Text("group"), Bytes(1 + 1 + 4 + more_bytes)};
}

const WireLayout& Desired() {
  static const WireLayout fields = CommandWith(4 + 1);
  return fields;
}
const WireLayout& Status() {
  static const WireLayout fields = CommandWith(3 * 4 + 4 + 2 * 8);
  return fields;
}

WireLayout LayoutFor(const procman_lcm::orders_t* /*type*/) {
  return {Bytes(8), Text("deputy_id"), Text("sheriff_id"), Count("ncmds", kMaxCommands),
          Group(&Desired(), "ncmds")};
}
WireLayout LayoutFor(const procman_lcm::deputy_info_t* /*type*/) {
  return {Bytes(8), Text("deputy_id"), Bytes(4 + 4 * 8), Count("ncmds", kMaxCommands),
          Group(&Status(), "ncmds")};
}
WireLayout LayoutFor(const procman_lcm::output_t* /*type*/) {
  return {Bytes(8), Text("deputy_name"), Text("command_id"), Text("text")};
}
WireLayout LayoutFor(const procman_lcm::discovery_t* /*type*/) { return {Bytes(8), Text("host"), Bytes(8)}; }

}  // namespace

template <typename Message>
bool DecodeProcman(const std::uint8_t* data, std::size_t size, Message* message, std::string* why) {
  static const WireLayout layout = LayoutFor(static_cast<const Message*>(nullptr));
  return CheckWire(layout, Message::getHash(), data, size, why) &&
         message->decode(data, 0, static_cast<int>(size)) == static_cast<int>(size);
}

template bool DecodeProcman(const std::uint8_t*, std::size_t, procman_lcm::orders_t*, std::string*);
template bool DecodeProcman(const std::uint8_t*, std::size_t, procman_lcm::deputy_info_t*, std::string*);
template bool DecodeProcman(const std::uint8_t*, std::size_t, procman_lcm::output_t*, std::string*);
template bool DecodeProcman(const std::uint8_t*, std::size_t, procman_lcm::discovery_t*, std::string*);

}  // namespace evit::procman
