#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evit/messages.hpp"

/// Decoding that trusts nothing: lengths, fingerprint, every count (before memory is reserved) and, in
/// Validate(), the meaning of fields (finite numbers, unit quaternions, sorted times, sizes that agree).
/// LCM's generated decoders trust the counts in a message: a forged one crashes them, so bytes are checked
/// first.
namespace evit {

/// Decodes `size` bytes into `message`. False (message untouched or partly filled, never a crash) where the
/// bytes are not exactly one well-formed, valid message of this type; `why`, where not null, says what is
/// wrong.
template <typename Message>
bool DecodeChecked(const std::uint8_t* data, std::size_t size, Message* message, std::string* why = nullptr);

/// Encodes into `buffer` (resized as needed, memory reused from call to call).
template <typename Message>
void EncodeTo(const Message& message, std::vector<std::uint8_t>* buffer);

}  // namespace evit
