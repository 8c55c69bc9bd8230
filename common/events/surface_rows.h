#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// The inner loops of the time surface: one fused pass from distances in time to the blurred, negated image,
/// a few rows at a time, so that everything in between stays in the first-level cache.
namespace evit {

/// Distances in time as 16-bit multiples of 2^shift us, limited to 65535: a plane fits the second-level
/// cache. out[i] = now - stamps[i].
void QuantizeDistances(const std::int32_t* stamps, std::size_t n, std::int32_t now, int shift,
                       std::uint16_t* out);

class SurfacePass {
 public:
  /// sigma: pixels of the Gaussian blur; 0: none. Radius 3 sigma, reflected at the border (101).
  SurfacePass(int width, int height, double sigma);

  struct Decay {
    double rate = 0;                  // 1 / decay, per unit of distance
    std::uint16_t max_distance = 0;   // units; beyond, T is 0
    std::uint16_t near_distance = 0;  // units; a neighbour within this supports a pixel
    bool support = false;
  };
  /// `distances` and `image`: [height][width].
  void Run(const std::uint16_t* distances, const Decay& decay, std::uint8_t* image);

 private:
  void DrawRow(const std::uint16_t* distances, int y, const Decay& decay);

  int width_, height_, radius_;
  std::size_t stride_;
  std::vector<std::uint16_t> weights_;  // in 1/65536; [0] the middle, then outwards
  float coefficients_[5] = {}, least_ = 0;
  std::vector<std::uint8_t> near_;  // ring of three rows, a pixel more on each side
  std::vector<std::uint8_t> column_, supported_;
  std::vector<std::uint16_t> visible_, padded_, sum_;  // one row each; padded_ is T with reflected borders
  std::vector<std::uint16_t> ring_;                    // 2 radius + 1 rows, blurred along x
};

}  // namespace evit
