#pragma once

#include <cstdint>
#include <cstdlib>

namespace evit::fuzz {

/// Which of `n` readers an input is for: its first byte says so, or EVIT_FUZZ_CHOICE for all inputs, so that
/// one format gets all the time (scripts/fuzz).
inline int Choice(std::uint8_t first, int n) {
  static const char* const kChosen = std::getenv("EVIT_FUZZ_CHOICE");
  return (kChosen != nullptr ? std::atoi(kChosen) : first) % n;
}

}  // namespace evit::fuzz
