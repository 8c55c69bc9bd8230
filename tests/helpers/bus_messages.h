#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/codec.h"

/// For tests: whole messages on a bus. What does not decode, or breaks a rule of the wire, fails the test.
namespace evit::test {

template <typename Message>
void Publish(Bus* bus, const std::string& channel, const Message& message) {
  std::vector<std::uint8_t> bytes;
  EncodeTo(message, &bytes);
  bus->Publish(channel, bytes.data(), bytes.size());
}

template <typename Message>
void Listen(Bus* bus, const std::string& channel, std::function<void(const Message&)> handler) {
  bus->Subscribe(channel, [=](const std::string&, const std::uint8_t* data, std::size_t size) {
    Message message;
    std::string why;
    ASSERT_TRUE(DecodeChecked(data, size, &message, &why)) << channel << ": " << why;
    handler(message);
  });
}

/// Appends all that comes.
template <typename Message>
void Keep(Bus* bus, const std::string& channel, std::vector<Message>* to) {
  Listen<Message>(bus, channel, [to](const Message& message) { to->push_back(message); });
}

}  // namespace evit::test
