#pragma once

#include <hdf5.h>

#include <cstddef>

namespace evit::formats {

/// H5Dread, with chunks that decompress to less than a chunk as an error: HDF5 itself takes a whole chunk
/// from what a filter hands back, however little that is, and gives out what lies behind it in memory.
herr_t ReadChunks(hid_t dataset, hid_t memory_type, hid_t memory, hid_t file, void* out);

/// How a filter ends, by HDF5's contract: the buffer is replaced by `made`, of malloc, whose first `n` bytes
/// count. Returns `n`; or 0, with `made` freed, where it is 0 or less than the chunk that ReadChunks expects.
std::size_t ReplaceChunk(void* made, std::size_t n, std::size_t capacity, std::size_t* buffer_size,
                         void** buffer);

}  // namespace evit::formats
