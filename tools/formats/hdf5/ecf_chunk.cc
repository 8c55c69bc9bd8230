#include "tools/formats/hdf5/ecf_chunk.h"

#include <algorithm>

namespace evit::formats {
namespace {

constexpr std::size_t kHead = 12, kMaxEvents = 65535;
constexpr int kLongestStep = 16;  // groups of four bits in a stamp

// Bytes that are taken from the front; where there are too few, all further ones are 0 and `whole` is false.
struct Bytes {
  const std::uint8_t* at;
  const std::uint8_t* end;
  bool whole = true;

  std::uint64_t Take(int bytes) {
    if (end - at < bytes) {
      whole = false;
      at = end;
      return 0;
    }
    std::uint64_t value = 0;
    for (int k = 0; k < bytes; ++k) value |= std::uint64_t{at[k]} << (8 * k);
    at += bytes;
    return value;
  }
  // How long a run is: `n` as it stands in `bits` bits, or what follows where they are all set.
  std::size_t Run(std::uint64_t n, int bits) { return n == (1U << bits) - 1 ? Take(2) : n; }
};

bool Stamps(Bytes* in, std::size_t n, H5Event* out) {
  std::uint64_t t = in->Take(8);
  for (std::size_t k = 0; k < n && in->whole;) {
    std::uint64_t byte = in->Take(1), step = 0;
    for (int group = 0; byte >> 4 == 15; ++group, byte = in->Take(1)) {
      if (group == kLongestStep) return false;
      step |= (byte & 15) << (4 * group);
    }
    t += step + (byte >> 4);
    const std::size_t run = in->Run(byte & 15, 4);
    if (run > n - k) return false;
    for (const std::size_t last = k + run; k < last; ++k) out[k].t = static_cast<std::int64_t>(t);
  }
  return in->whole;
}

// Runs of one value: `value_bits` above `run_bits` in words of `bytes`.
template <typename Set>
bool Runs(Bytes* in, std::size_t n, int bytes, int run_bits, const Set& set) {
  for (std::size_t k = 0; k < n && in->whole;) {
    const std::uint64_t word = in->Take(bytes);
    const std::size_t run = in->Run(word & ((1U << run_bits) - 1), run_bits);
    if (run > n - k) return false;
    for (const std::size_t last = k + run; k < last; ++k) set(k, word >> run_bits);
  }
  return in->whole;
}

// Four values of 6 * `bytes` bits in three words of `bytes`.
template <typename Set>
bool Quads(Bytes* in, std::size_t n, int bytes, const Set& set) {
  const int bits = 6 * bytes, low = 2 * bytes;
  const auto mask = [](int m) { return (std::uint64_t{1} << m) - 1; };
  for (std::size_t k = 0; k < n; k += 4) {
    const std::uint64_t a = in->Take(bytes), b = in->Take(bytes), c = in->Take(bytes);
    if (!in->whole) return false;
    const std::uint64_t values[] = {a >> low, (b >> 2 * low) << low | (a & mask(low)),
                                    (c >> bits) << 2 * low | (b & mask(2 * low)), c & mask(bits)};
    for (std::size_t j = 0; j < std::min<std::size_t>(4, n - k); ++j) set(k + j, values[j]);
  }
  return true;
}

bool Columns(Bytes* in, std::size_t n, H5Event* out) {
  for (std::size_t k = 0; k < n;) {
    const auto word = static_cast<unsigned>(in->Take(2));
    if (!in->whole) return false;
    out[k++].x = static_cast<std::uint16_t>(word >> 5);
    for (unsigned step = 1; step <= 5 && k < n; ++step) {
      if ((word >> (5 - step) & 1) != 0) out[k++].x = static_cast<std::uint16_t>((word >> 5) + step);
    }
  }
  return true;
}

}  // namespace

std::size_t EcfEvents(const std::uint8_t* data, std::size_t size) {
  if (size < kHead) return 0;
  const std::size_t n = Bytes{data, data + size}.Take(4) >> 2;
  return n <= kMaxEvents ? n : 0;
}

bool DecodeEcf(const std::uint8_t* data, std::size_t size, H5Event* out) {
  const std::size_t n = EcfEvents(data, size);
  if (n == 0) return false;
  Bytes in{data, data + size};
  const std::uint64_t head = in.Take(4);
  if (!Stamps(&in, n, out)) return false;
  const auto x_and_p = [out](std::size_t k, std::uint64_t value) {
    out[k].x = value >> 1 & 2047;
    out[k].p = value & 1;
  };
  if ((head & 2) != 0) {
    return Quads(&in, n, 4, [&](std::size_t k, std::uint64_t value) {
      out[k].y = value >> 12 & 2047;
      x_and_p(k, value);
    });
  }
  if (!Runs(&in, n, 2, 5,
            [out](std::size_t k, std::uint64_t y) { out[k].y = static_cast<std::uint16_t>(y); }))
    return false;
  if ((head & 1) != 0) return Quads(&in, n, 2, x_and_p);
  return Columns(&in, n, out) && Runs(&in, n, 1, 7, [out](std::size_t k, std::uint64_t p) {
           out[k].p = static_cast<std::int16_t>(p);
         });
}

}  // namespace evit::formats
