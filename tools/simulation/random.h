#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace evit::simulation {

/// Seeded random numbers, the same on every platform (no std::*_distribution). Each purpose takes a `stream`
/// of its own, so that drawing more numbers for one does not change the others. Generator: SplitMix64.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : state_(seed * 0x9E3779B97F4A7C15ULL + 1) {
    state_ = Next() ^ (stream * 0xD1B54A32D192ED03ULL);
    Next();
  }

  std::uint64_t Next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  /// In [0, 1).
  double Uniform() { return static_cast<double>(Next() >> 11) * 0x1.0p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  /// In low..high, both included.
  int Integer(int low, int high) {
    return low + static_cast<int>(Next() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool Chance(double probability) { return Uniform() < probability; }

  /// Standard normal (Box-Muller; the second value is not kept, so that one call is one draw).
  double Gaussian() {
    const double u = 1.0 - Uniform(), v = Uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
  }
  Eigen::Vector3d GaussianVector() {
    const double x = Gaussian(), y = Gaussian(), z = Gaussian();
    return {x, y, z};
  }
  /// A direction, uniform on the sphere.
  Eigen::Vector3d Direction() {
    Eigen::Vector3d v = GaussianVector();
    while (v.norm() < 1e-6) v = GaussianVector();
    return v.normalized();
  }
  /// Gap to the next event of a Poisson process with this mean.
  double Exponential(double mean) { return -mean * std::log(1.0 - Uniform()); }

 private:
  std::uint64_t state_;
};

}  // namespace evit::simulation
