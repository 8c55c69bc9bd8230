#include "tools/formats/hdf5/zstd_filter.h"

#include <hdf5.h>
#include <zstd.h>

#include <cstdlib>
#include <stdexcept>

#include "tools/formats/hdf5/h5_chunk.h"

namespace evit::formats {
namespace {

// Largest chunk that is accepted: a forged frame header must not decide how much memory is reserved.
constexpr unsigned long long kMaxChunk = 1ULL << 30;

std::size_t Filter(unsigned flags, std::size_t n_values, const unsigned* values, std::size_t n_bytes,
                   std::size_t* buffer_size, void** buffer) {
  const bool decompress = (flags & H5Z_FLAG_REVERSE) != 0;
  const unsigned long long capacity =
      decompress ? ZSTD_getFrameContentSize(*buffer, n_bytes) : ZSTD_compressBound(n_bytes);
  if (capacity == 0 || capacity > kMaxChunk) return 0;  // unknown and error values are huge numbers
  void* out = std::malloc(capacity);
  if (out == nullptr) return 0;
  const int level = n_values > 0 ? static_cast<int>(values[0]) : 3;
  const std::size_t n = decompress ? ZSTD_decompress(out, capacity, *buffer, n_bytes)
                                   : ZSTD_compress(out, capacity, *buffer, n_bytes, level);
  return ReplaceChunk(out, ZSTD_isError(n) != 0 ? 0 : n, capacity, buffer_size, buffer);
}

}  // namespace

void RegisterZstdFilter() {
  H5dont_atexit();  // it would crash there after a file could not be closed: on a full disk
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are ours to word
  if (H5Zfilter_avail(kZstdFilter) > 0) return;
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, kZstdFilter, 1, 1, "Zstandard", nullptr, nullptr, Filter};
  if (H5Zregister(&filter) < 0) throw std::runtime_error("HDF5 refuses to register the Zstandard filter");
}

}  // namespace evit::formats
