#pragma once

#include <string>
#include <vector>

#include "tools/formats/hdf5/h5_file.h"

namespace evit {

/// Writes chunks as tools/formats/hdf5/ecf_chunk.h describes them, in each of the three ways, for tests.
class EcfEncoder {
 public:
  enum class Way { kMasks = 0, kColumnsPacked = 1, kAllPacked = 2 };

  static std::string Encode(const std::vector<formats::H5Event>& events, Way way) {
    EcfEncoder e;
    e.Put(events.size() << 2 | static_cast<unsigned>(way), 4);
    e.Put(static_cast<std::uint64_t>(events.empty() ? 0 : events[0].t), 8);
    e.Stamps(events);
    if (way == Way::kAllPacked) {
      e.Quads(events, 4, [](const formats::H5Event& v) {
        return std::uint64_t{v.y} << 12 | std::uint64_t{v.x} << 1 | static_cast<std::uint64_t>(v.p);
      });
      return e.out_;
    }
    e.Runs(events, 2, 5, [](const formats::H5Event& v) { return std::uint64_t{v.y}; });
    if (way == Way::kColumnsPacked) {
      e.Quads(events, 2, [](const formats::H5Event& v) {
        return std::uint64_t{v.x} << 1 | static_cast<std::uint64_t>(v.p);
      });
      return e.out_;
    }
    e.Masks(events);
    e.Runs(events, 1, 7, [](const formats::H5Event& v) { return static_cast<std::uint64_t>(v.p); });
    return e.out_;
  }

 private:
  void Put(std::uint64_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) out_ += static_cast<char>(value >> (8 * k));
  }
  void PutRun(std::uint64_t value, int bytes, int run_bits, std::size_t run) {
    const std::uint64_t full = (1U << run_bits) - 1;
    Put(value << run_bits | (run < full ? run : full), bytes);
    if (run >= full) Put(run, 2);
  }
  template <typename Get>
  static std::size_t Run(const std::vector<formats::H5Event>& events, std::size_t begin, const Get& get) {
    std::size_t end = begin + 1;
    while (end < events.size() && get(events[end]) == get(events[begin])) ++end;
    return end - begin;
  }
  void Stamps(const std::vector<formats::H5Event>& events) {
    const auto stamp = [](const formats::H5Event& v) { return v.t; };
    std::int64_t before = events.empty() ? 0 : events[0].t;
    for (std::size_t k = 0; k < events.size();) {
      auto step = static_cast<std::uint64_t>(events[k].t - before);
      before = events[k].t;
      const std::size_t run = Run(events, k, stamp);
      if (step >= 15) {
        for (; step > 0; step >>= 4) Put(0xF0 | (step & 15), 1);
      }
      PutRun(step, 1, 4, run);
      k += run;
    }
  }
  template <typename Get>
  void Runs(const std::vector<formats::H5Event>& events, int bytes, int run_bits, const Get& get) {
    for (std::size_t k = 0; k < events.size();) {
      const std::size_t run = Run(events, k, get);
      PutRun(get(events[k]), bytes, run_bits, run);
      k += run;
    }
  }
  void Masks(const std::vector<formats::H5Event>& events) {
    for (std::size_t k = 0; k < events.size();) {
      const unsigned x = events[k++].x;
      unsigned mask = 0;
      for (unsigned step = 1; step <= 5; ++step) {
        if (k < events.size() && events[k].x == x + step) {
          mask |= 32U >> step;
          ++k;
        }
      }
      Put(x << 5 | mask, 2);
    }
  }
  template <typename Get>
  void Quads(const std::vector<formats::H5Event>& events, int bytes, const Get& get) {
    const int low = 2 * bytes;
    const std::uint64_t word = (std::uint64_t{1} << (8 * bytes)) - 1;
    for (std::size_t k = 0; k < events.size(); k += 4) {
      std::uint64_t v[4] = {};
      for (std::size_t j = 0; j < 4 && k + j < events.size(); ++j) v[j] = get(events[k + j]);
      Put((v[0] << low | (v[1] & ((1U << low) - 1))) & word, bytes);
      Put(((v[1] >> low) << 2 * low | (v[2] & ((1U << 2 * low) - 1))) & word, bytes);
      Put(((v[2] >> 2 * low) << 3 * low | v[3]) & word, bytes);
    }
  }

  std::string out_;
};

}  // namespace evit
