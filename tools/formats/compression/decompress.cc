#include "tools/formats/compression/decompress.h"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace evit::formats {
namespace {

constexpr std::size_t kFirst = 1 << 16;  // bytes

// Calls `step(out, capacity, &n_out)` until it returns true (the frame has ended), with a buffer that grows.
template <typename Step>
void Grow(const char* what, std::size_t limit, std::vector<std::uint8_t>* out, const Step& step) {
  out->resize(std::min(limit, std::max(kFirst, out->capacity())));
  std::size_t n = 0;
  while (true) {
    std::size_t n_out = out->size() - n;
    const bool ended = step(out->data() + n, &n_out);
    n += n_out;
    if (ended) break;
    if (n < out->size()) throw std::runtime_error(std::string("a ") + what + " frame is cut off");
    if (out->size() >= limit)
      throw std::runtime_error(std::string("a ") + what + " frame is larger than " +
                               std::to_string(limit >> 20) + " MB");
    out->resize(std::min(limit, 2 * out->size()));
  }
  out->resize(n);
}

}  // namespace

void DecompressLz4(const std::uint8_t* data, std::size_t size, std::size_t limit,
                   std::vector<std::uint8_t>* out) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0)
    throw std::runtime_error("no memory for LZ4");
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(made,
                                                                             LZ4F_freeDecompressionContext);
  std::size_t at = 0;
  Grow("LZ4", limit, out, [&](std::uint8_t* to, std::size_t* n_out) {
    std::size_t n_in = size - at;
    const std::size_t hint = LZ4F_decompress(context.get(), to, n_out, data + at, &n_in, nullptr);
    if (LZ4F_isError(hint) != 0)
      throw std::runtime_error(std::string("an LZ4 frame is damaged: ") + LZ4F_getErrorName(hint));
    at += n_in;
    return hint == 0;
  });
}

void DecompressZstd(const std::uint8_t* data, std::size_t size, std::size_t limit,
                    std::vector<std::uint8_t>* out) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) throw std::runtime_error("no memory for Zstandard");
  ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, 27);  // 128 MB
  ZSTD_inBuffer in{data, size, 0};
  Grow("Zstandard", limit, out, [&](std::uint8_t* to, std::size_t* n_out) {
    ZSTD_outBuffer piece{to, *n_out, 0};
    std::size_t hint = 1;
    while (hint != 0 && piece.pos < piece.size) {
      const std::size_t before_in = in.pos, before_out = piece.pos;
      hint = ZSTD_decompressStream(stream.get(), &piece, &in);
      if (ZSTD_isError(hint) != 0)
        throw std::runtime_error(std::string("a Zstandard frame is damaged: ") + ZSTD_getErrorName(hint));
      if (in.pos == before_in && piece.pos == before_out) break;
    }
    *n_out = piece.pos;
    return hint == 0;
  });
}

}  // namespace evit::formats
