#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evit {

/// Points around some place, as arrays: a multiple of kLanes of them.
struct Surroundings {
  std::vector<float> x, y, z;       // m
  std::vector<float> count;         // how many points each stands for
  std::vector<std::int32_t> index;  // the caller's

  std::size_t size() const { return x.size(); }
  void Clear();
  void Add(float px, float py, float pz, float stands_for, std::int32_t its_index);
};

/// Some of them relative to a point, as arrays with zeros after the last up to a multiple of kLanes.
struct NearPoints {
  std::vector<float> dx, dy, dz;  // m
  std::vector<float> count;
  std::size_t room = 0;  // that multiple
};

/// Those within the radius of p (m), in their order; the one whose index is `self` counts for none. The same
/// bits on every machine.
void FindNear(const Surroundings& around, const float* p, float radius2, std::int32_t self, NearPoints* near);

}  // namespace evit
