#pragma once

#include <cstddef>
#include <cstdint>

/// What a message may hold at most; lengths of arrays have theirs in lcmtypes/ ("at most"). Far above what is
/// sent, far below what would harm: a forged count costs no more than this.
namespace evit {

constexpr std::size_t kMaxMessageBytes = std::size_t{16} << 20;  // LCM itself gives up at 65535 fragments
constexpr std::int32_t kMaxImageSide = 8192;                     // pixels
constexpr std::int32_t kMaxMapPoints = 1'000'000;                // in one answer
constexpr std::int64_t kMaxTime = std::int64_t{1} << 60;  // us, either sign: differences never overflow
constexpr std::int64_t kMaxSequence = std::int64_t{1}
                                      << 40;  // message numbers: far beyond any sender's lifetime

}  // namespace evit
