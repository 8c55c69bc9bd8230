#include "tools/formats/vector/lzf_filter.h"

#include <hdf5.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "common/map/map_formats.h"
#include "tools/formats/vector/h5_chunk.h"

namespace evit::formats {
namespace {

// Largest chunk that is accepted: a forged number must not decide how much memory is reserved.
constexpr std::size_t kMaxChunk = std::size_t{1} << 30;

// h5py's third value is the chunk's size.
std::size_t Filter(unsigned flags, std::size_t n_values, const unsigned* values, std::size_t n_bytes,
                   std::size_t* buffer_size, void** buffer) {
  const std::size_t size = n_values > 2 ? values[2] : 0;
  if ((flags & H5Z_FLAG_REVERSE) == 0 || size == 0 || size > kMaxChunk) return 0;
  void* out = std::malloc(size);
  if (out == nullptr) return 0;
  const bool whole = DecompressLzf(static_cast<const std::uint8_t*>(*buffer), n_bytes,
                                   static_cast<std::uint8_t*>(out), size);
  return ReplaceChunk(out, whole ? size : 0, size, buffer_size, buffer);
}

}  // namespace

void RegisterLzfFilter() {
  if (H5Zfilter_avail(kLzfFilter) > 0) return;
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, kLzfFilter, 0, 1, "LZF", nullptr, nullptr, Filter};
  if (H5Zregister(&filter) < 0) throw std::runtime_error("HDF5 refuses to register the LZF filter");
}

}  // namespace evit::formats
