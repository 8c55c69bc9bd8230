#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "evit/map_points_t.hpp"

namespace evit::monitor {

/// The map as viewers get it: from a file, in random order, so that its first points are an even sample of
/// all (a viewer whose graphics are slow draws only those while the view moves); or gathered from
/// map_server's answers to the tracker, in the order in which points became known. At most four million
/// points (48 MB).
class MapStore {
 public:
  static constexpr std::size_t kMostPoints = 4'000'000;

  /// A whole map; of one with too many points, a random sample.
  void Set(std::vector<Eigen::Vector3f> points);
  /// An answer of map_server, which has been checked. No effect on a whole map.
  void Add(const map_points_t& answer);

  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  /// Another one: the points before are of another map.
  std::uint32_t generation() const { return generation_; }
  /// As many points() will be at most, once all are known.
  std::int64_t capacity() const { return whole_ ? static_cast<std::int64_t>(points_.size()) : total_; }
  /// Points of the whole map; 0: not known.
  std::int64_t total() const { return total_; }

 private:
  bool whole_ = false;
  std::vector<Eigen::Vector3f> points_;
  std::vector<bool> known_;  // by id
  std::int64_t total_ = 0;
  std::int64_t map_id_ = 0;  // as map_server names it
  std::uint32_t generation_ = 1;
};

}  // namespace evit::monitor
