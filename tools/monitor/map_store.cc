#include "tools/monitor/map_store.h"

#include <utility>

namespace evit::monitor {

void MapStore::Set(std::vector<Eigen::Vector3f> points) {
  whole_ = true;
  ++generation_;
  total_ = static_cast<std::int64_t>(points.size());
  const std::size_t step = points.size() / kMostPoints + 1;
  if (step == 1) {
    points_ = std::move(points);
    return;
  }
  points_.clear();
  for (std::size_t i = 0; i < points.size(); i += step) points_.push_back(points[i]);
}

void MapStore::Add(const map_points_t& answer) {
  if (whole_ || answer.map_size > static_cast<std::int64_t>(kMostPoints)) return;
  // A map_server that was started again may serve another map; one of the same size is taken for the same.
  if (answer.map_size != total_) {
    points_.clear();
    known_.assign(static_cast<std::size_t>(answer.map_size), false);
    total_ = answer.map_size;
    ++generation_;
  }
  for (std::size_t i = 0; i < answer.id.size(); ++i) {
    const auto id = static_cast<std::size_t>(answer.id[i]);
    if (answer.id[i] < 0 || id >= known_.size() || known_[id]) continue;
    known_[id] = true;
    points_.emplace_back(answer.xyz[i][0], answer.xyz[i][1], answer.xyz[i][2]);
  }
}

}  // namespace evit::monitor
