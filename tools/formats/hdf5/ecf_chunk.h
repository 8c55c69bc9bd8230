#pragma once

#include <cstddef>
#include <cstdint>

#include "tools/formats/hdf5/h5_file.h"

namespace evit::formats {

/// One chunk compressed by Prophesee's ECF (HDF5 filter 0x8ECF). The format has no written specification;
/// this is what the vendor's codec writes, by github.com/prophesee-ai/hdf5_ecf as it stood under Apache 2.0
/// (51fa1bc6). All little-endian:
///
///   u32  events N << 2 | A << 1 | B; N at most 65535
///   u64  stamp that the first step counts from, us
///   ...  stamps, as runs, until N events have one: a byte d << 4 | n says that n events lie d us later than
///        the run before; n = 15: a u16 with the number follows. d = 15: the byte is four bits of a longer
///        step, the lowest first, which is added before the next run's own d.
///   A = 1: rows, columns and polarities together, 24 bits an event, y << 12 | x << 1 | p. Four events
///        e, f, g, h lie in three u32: e << 8 | the low 8 bits of f; the other 16 of f << 16 | the low 16 of
///        g; the other 8 of g << 24 | h. The last four are filled up.
///   A = 0: rows as runs of u16, y << 5 | n; n = 31: a u16 with the number follows. Then
///     B = 1: columns and polarities, 12 bits an event, x << 1 | p, four of them in three u16 in the same
///        way: e << 4 | 4 bits of f; 8 of f << 8 | 8 of g; 4 of g << 12 | h.
///     B = 0: columns as u16, x << 5 | m: an event at x, and of the five columns x + 1 ... x + 5 one more
///        event for each bit of m, the highest for x + 1. Bits after the Nth event mean nothing. Then
///        polarities as runs of u8, p << 7 | n; n = 127: a u16 with the number follows.
///
/// The number of events that the header claims; 0 where the chunk is too short to hold any or claims too
/// many.
std::size_t EcfEvents(const std::uint8_t* data, std::size_t size);

/// Writes EcfEvents() events to `out`. False where the chunk ends early or a run is longer than what is left.
bool DecodeEcf(const std::uint8_t* data, std::size_t size, H5Event* out);

}  // namespace evit::formats
