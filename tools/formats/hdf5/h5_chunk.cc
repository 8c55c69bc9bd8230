#include "tools/formats/hdf5/h5_chunk.h"

#include <cstdlib>

#include "tools/formats/hdf5/h5_handle.h"

namespace evit::formats {
namespace {

constexpr int kMaxRank = 32;                // HDF5's
thread_local std::size_t g_chunk_size = 0;  // bytes; 0: any will do. Filters have no other way to know it.

// Filters that leave a chunk as long as it is, or whose own four bytes HDF5 checks itself.
bool KeepsLength(H5Z_filter_t filter) {
  return filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_FLETCHER32;
}

// 0 where it has no chunks, or where several filters change their length one after the other.
std::size_t ChunkSize(hid_t dataset) {
  const H5Handle properties(H5Dget_create_plist(dataset), H5Pclose), type(H5Dget_type(dataset), H5Tclose);
  if (H5Pget_layout(properties.get()) != H5D_CHUNKED) return 0;
  int n_changing = 0;
  for (int k = 0; k < H5Pget_nfilters(properties.get()); ++k) {
    std::size_t n_values = 0;
    unsigned flags = 0, config = 0;
    if (!KeepsLength(H5Pget_filter2(properties.get(), static_cast<unsigned>(k), &flags, &n_values, nullptr, 0,
                                    nullptr, &config)))
      ++n_changing;
  }
  hsize_t shape[kMaxRank] = {};
  const int rank = H5Pget_chunk(properties.get(), kMaxRank, shape);
  if (n_changing != 1 || rank < 1) return 0;
  std::size_t size = H5Tget_size(type.get());
  for (int k = 0; k < rank; ++k) size *= shape[k];
  return size;
}

}  // namespace

herr_t ReadChunks(hid_t dataset, hid_t memory_type, hid_t memory, hid_t file, void* out) {
  g_chunk_size = ChunkSize(dataset);
  const herr_t status = H5Dread(dataset, memory_type, memory, file, H5P_DEFAULT, out);
  g_chunk_size = 0;
  return status;
}

std::size_t ReplaceChunk(void* made, std::size_t n, std::size_t capacity, std::size_t* buffer_size,
                         void** buffer) {
  if (n == 0 || n < g_chunk_size) {
    std::free(made);
    return 0;
  }
  std::free(*buffer);
  *buffer = made;
  *buffer_size = capacity;
  return n;
}

}  // namespace evit::formats
