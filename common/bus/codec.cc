#include "common/bus/codec.h"

#include <stdexcept>

#include "common/bus/validate.h"
#include "common/bus/wire_layout.h"

namespace evit {
namespace {

/// Calls visit(name, count, vector) for each array of `m` whose length another field says. Generated code
/// keeps the two apart: encoding with a vector that is too short would read past its end, and decoding a
/// message with n = 0 into a used object would leave the old vector there.
template <typename Message, typename Visitor>
void VisitArrays(Message& m, const Visitor& visit) {
  VisitArraysOf(static_cast<const Message*>(nullptr), m, visit);
}

}  // namespace

template <typename Message>
bool DecodeChecked(const std::uint8_t* data, std::size_t size, Message* message, std::string* why) {
  if (!CheckWire(LayoutOf<Message>(), Message::getHash(), data, size, why)) return false;
  if (message->decode(data, 0, static_cast<int>(size)) != static_cast<int>(size)) {
    if (why != nullptr) *why = "LCM's decoder refused it";
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
EVIT_MESSAGES(EVIT_INSTANTIATE)
#undef EVIT_INSTANTIATE

}  // namespace evit
