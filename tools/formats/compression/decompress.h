#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evit::formats {

/// Decompresses one whole frame into `out` (replaced; its memory is used again). No more than `limit` bytes
/// are ever reserved: a forged length must not decide that. Both throw std::runtime_error: damaged, cut off,
/// or larger than the limit.
void DecompressLz4(const std::uint8_t* data, std::size_t size, std::size_t limit,
                   std::vector<std::uint8_t>* out);
void DecompressZstd(const std::uint8_t* data, std::size_t size, std::size_t limit,
                    std::vector<std::uint8_t>* out);

}  // namespace evit::formats
