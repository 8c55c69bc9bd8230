#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace evit {

/// LCM's messages out of its UDP datagrams (LC02: a whole message; LC03: a fragment of one). Of each sender
/// one message at a time is put together, fragments in any order after the first; what does not fit together
/// is dropped. Memory is bounded. Trusts no length in a datagram.
class MessageAssembler {
 public:
  struct Message {
    std::string_view channel;
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;  // bytes
    bool fragmented = false;
  };

  /// One datagram of `sender` (any number that tells senders apart). True where it completes a message, which
  /// is valid until the next call: it lies in the datagram, or, where it came in fragments, in memory of this
  /// object's.
  bool Add(std::uint64_t sender, const std::uint8_t* datagram, std::size_t size, Message* message);

  /// After Add() gave a message in fragments: exchanges its memory, which begins with the message, for other.
  /// Without it the memory is used for the next message.
  void ExchangeMemory(std::vector<std::uint8_t>* memory) { memory->swap(done_.memory); }

 private:
  static constexpr std::size_t kMaxSenders = 32;

  struct Assembly {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;   // the sender's, of the message
    std::size_t size = 0;       // bytes of the whole message
    std::size_t remaining = 0;  // fragments that have not come
    std::string channel;
    std::vector<bool> has;  // by fragment
    std::vector<std::uint8_t> memory;
  };
  bool AddFragment(std::uint64_t sender, const std::uint8_t* datagram, std::size_t size, Message* message);
  Assembly* Begin(std::uint64_t sender, std::uint32_t number, std::size_t size, std::size_t n_fragments,
                  std::string_view channel);

  std::vector<Assembly> assemblies_;  // oldest first
  Assembly done_;                     // the message last completed; its memory is used again
};

}  // namespace evit
