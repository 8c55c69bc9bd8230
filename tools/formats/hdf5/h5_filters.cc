#include "tools/formats/hdf5/h5_filters.h"

#include <blosc.h>
#include <hdf5.h>
#include <liblzf/lzf.h>
#include <lz4.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "tools/formats/hdf5/ecf_chunk.h"
#include "tools/formats/hdf5/h5_chunk.h"
#include "tools/formats/hdf5/zstd_filter.h"

namespace evit::formats {
namespace {

constexpr H5Z_filter_t kLzf = 32000, kBlosc = 32001, kLz4 = 32004, kEcf = 0x8ECF;
constexpr std::size_t kMaxChunk = std::size_t{1}
                                  << 30;  // bytes; a forged length must not decide what is reserved

std::uint64_t BigEndian(const std::uint8_t* data, int bytes) {
  std::uint64_t value = 0;
  for (int k = 0; k < bytes; ++k) value = value << 8 | data[k];
  return value;
}

// h5py's LZF: the third value is the chunk's size, which the frame itself does not say.
std::size_t Lzf(unsigned flags, std::size_t n_values, const unsigned* values, std::size_t n_bytes,
                std::size_t* buffer_size, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0) return 0;
  std::size_t capacity = n_values >= 3 && values[2] != 0 ? values[2] : *buffer_size;
  for (; capacity > 0 && capacity <= kMaxChunk; capacity *= 2) {
    void* out = std::malloc(capacity);
    if (out == nullptr) return 0;
    const unsigned n =
        lzf_decompress(*buffer, static_cast<unsigned>(n_bytes), out, static_cast<unsigned>(capacity));
    if (n > 0) return ReplaceChunk(out, n, capacity, buffer_size, buffer);
    std::free(out);
    if (errno != E2BIG) return 0;
  }
  return 0;
}

std::size_t Blosc(unsigned flags, std::size_t /*n_values*/, const unsigned* /*values*/, std::size_t n_bytes,
                  std::size_t* buffer_size, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0) return 0;
  std::size_t size = 0;
  if (blosc_cbuffer_validate(*buffer, n_bytes, &size) < 0 || size == 0 || size > kMaxChunk) return 0;
  void* out = std::malloc(size);
  if (out == nullptr) return 0;
  const int n = blosc_decompress_ctx(*buffer, out, size, 1);
  return ReplaceChunk(out, n > 0 ? static_cast<std::size_t>(n) : 0, size, buffer_size, buffer);
}

// The plug-in's frame: size of the whole (8 bytes, big-endian), of a block (4); then blocks, each with its
// packed size in front (4); a block that would not shrink is stored.
std::size_t Lz4(unsigned flags, std::size_t /*n_values*/, const unsigned* /*values*/, std::size_t n_bytes,
                std::size_t* buffer_size, void** buffer) {
  const auto* in = static_cast<const std::uint8_t*>(*buffer);
  if ((flags & H5Z_FLAG_REVERSE) == 0 || n_bytes < 12) return 0;
  const std::uint64_t size = BigEndian(in, 8), block = BigEndian(in + 8, 4);
  if (size == 0 || size > kMaxChunk || block == 0) return 0;
  auto* out = static_cast<std::uint8_t*>(std::malloc(size));
  if (out == nullptr) return 0;
  std::size_t at = 12, n = 0;
  while (n < size && n_bytes - at >= 4) {
    const std::uint64_t packed = BigEndian(in + at, 4), plain = std::min(block, size - n);
    at += 4;
    if (packed > n_bytes - at) break;
    if (packed == plain) {
      std::memcpy(out + n, in + at, plain);
    } else if (LZ4_decompress_safe(reinterpret_cast<const char*>(in + at), reinterpret_cast<char*>(out + n),
                                   static_cast<int>(packed),
                                   static_cast<int>(plain)) != static_cast<int>(plain)) {
      break;
    }
    at += packed;
    n += plain;
  }
  return ReplaceChunk(out, n == size ? n : 0, size, buffer_size, buffer);
}

// Ours even where the vendor's plug-in is installed, which trusts the lengths in the file.
std::size_t Ecf(unsigned flags, std::size_t /*n_values*/, const unsigned* /*values*/, std::size_t n_bytes,
                std::size_t* buffer_size, void** buffer) {
  const auto* in = static_cast<const std::uint8_t*>(*buffer);
  const std::size_t size = EcfEvents(in, n_bytes) * sizeof(H5Event);
  if ((flags & H5Z_FLAG_REVERSE) == 0 || size == 0) return 0;
  void* out = std::calloc(size, 1);
  if (out == nullptr) return 0;
  return ReplaceChunk(out, DecodeEcf(in, n_bytes, static_cast<H5Event*>(out)) ? size : 0, size, buffer_size,
                      buffer);
}

void Register(H5Z_filter_t id, const char* name, H5Z_func_t function) {
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, id, 1, 1, name, nullptr, nullptr, function};
  H5Zregister(&filter);
}

}  // namespace

void RegisterFilters() {
  static const bool kDone = [] {
    RegisterZstdFilter();
    Register(kLzf, "LZF", Lzf);
    Register(kBlosc, "Blosc", Blosc);
    Register(kLz4, "LZ4", Lz4);
    Register(kEcf, "ECF", Ecf);
    return true;
  }();
  static_cast<void>(kDone);
}

std::string FilterRemedy(int filter) {
  return "filter " + std::to_string(filter) +
         ": install its plug-in (Debian: hdf5-filter-plugin) and set HDF5_PLUGIN_PATH to its folder, or "
         "write the file again "
         "with gzip: h5repack -f GZIP=4";
}

}  // namespace evit::formats
