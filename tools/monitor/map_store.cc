#include "tools/monitor/map_store.h"

#include <algorithm>
#include <random>
#include <utility>

namespace evit::monitor {

void MapStore::Set(std::vector<Eigen::Vector3f> points) {
  whole_ = true;
  ++generation_;
  total_ = static_cast<std::int64_t>(points.size());
  points_ = std::move(points);
  std::mt19937 random(1);  // the same order each time
  std::shuffle(points_.begin(), points_.end(), random);
  if (points_.size() > kMostPoints) points_.resize(kMostPoints);
  points_.shrink_to_fit();
}

void MapStore::Add(const map_points_t& answer) {
  if (whole_ || answer.map_size > static_cast<std::int64_t>(kMostPoints)) return;
  // A map_server that was started again may serve another map.
  if (answer.map_size != total_ || answer.map_id != map_id_) {
    points_.clear();
    known_.assign(static_cast<std::size_t>(answer.map_size), false);
    total_ = answer.map_size;
    map_id_ = answer.map_id;
    ++generation_;
  }
  for (std::size_t i = 0; i < answer.id.size(); ++i) {
    const auto id = static_cast<std::size_t>(answer.id[i]);
    if (answer.id[i] < 0 || id >= known_.size() || known_[id]) continue;
    known_[id] = true;
    points_.emplace_back(answer.x[i], answer.y[i], answer.z[i]);
  }
}

}  // namespace evit::monitor
