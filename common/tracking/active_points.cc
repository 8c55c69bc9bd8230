#include "common/tracking/active_points.h"

#include <algorithm>
#include <numeric>

namespace evit {
namespace {

constexpr int kTile = 32;  // pixels
constexpr double kBorder =
    4;  // pixels: points closer to the edge would leave the image while the solver moves

// SplitMix64: a well-mixed number per (seed, salt, id), without state.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

ActivePoints::ActivePoints(Camera camera, SE3 T_camera_body, std::uint64_t seed)
    : camera_(std::move(camera)), T_camera_body_(std::move(T_camera_body)), seed_(seed) {}

void ActivePoints::Clear() {
  ids_.clear();
  points_.clear();
}

void ActivePoints::Merge(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  std::vector<std::int32_t> merged_ids;
  std::vector<Eigen::Vector3f> merged;
  merged_ids.reserve(ids_.size() + ids.size());
  merged.reserve(ids_.size() + ids.size());
  std::size_t a = 0;
  const auto take_old = [&](std::size_t k) { merged_ids.push_back(ids_[k]), merged.push_back(points_[k]); };
  for (const std::size_t b : order) {
    while (a < ids_.size() && ids_[a] < ids[b]) take_old(a++);
    if (a < ids_.size() && ids_[a] == ids[b]) ++a;  // the newer answer counts
    if (!merged_ids.empty() && merged_ids.back() == ids[b]) continue;
    merged_ids.push_back(ids[b]);
    merged.push_back(points[b]);
  }
  while (a < ids_.size()) take_old(a++);
  ids_.swap(merged_ids);
  points_.swap(merged);
}

void ActivePoints::Retain(const std::vector<SE3>& T_world_body, double margin_px) {
  std::size_t kept = 0;
  std::vector<SE3> T_camera_world;
  for (const SE3& pose : T_world_body) T_camera_world.push_back(T_camera_body_ * pose.Inverse());
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    const bool seen = std::any_of(T_camera_world.begin(), T_camera_world.end(), [&](const SE3& T) {
      Eigen::Vector2d pixel;
      return camera_.Project(T * points_[k].cast<double>(), &pixel) && camera_.Contains(pixel, -margin_px);
    });
    if (!seen) continue;
    ids_[kept] = ids_[k];
    points_[kept++] = points_[k];
  }
  ids_.resize(kept);
  points_.resize(kept);
}

std::vector<Eigen::Vector3f> ActivePoints::Sample(const SE3& T_world_body, int count,
                                                  std::uint64_t salt) const {
  struct Candidate {
    std::uint64_t key;
    std::size_t index;
    int tile, turn;
  };
  const SE3 T_camera_world = T_camera_body_ * T_world_body.Inverse();
  const int columns = camera_.width / kTile + 1, rows = camera_.height / kTile + 1;
  std::vector<Candidate> candidates;
  candidates.reserve(ids_.size());
  const std::uint64_t base = Mix(seed_ ^ Mix(salt));
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    Eigen::Vector2d pixel;
    if (!camera_.Project(T_camera_world * points_[k].cast<double>(), &pixel) ||
        !camera_.Contains(pixel, kBorder)) {
      continue;
    }
    const int tile = static_cast<int>(pixel.y()) / kTile * columns + static_cast<int>(pixel.x()) / kTile;
    candidates.push_back({Mix(base ^ static_cast<std::uint64_t>(ids_[k])), k, tile, 0});
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.key < b.key; });
  std::vector<int> taken(static_cast<std::size_t>(columns * rows), 0);
  for (Candidate& c : candidates) c.turn = taken[c.tile]++;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.turn < b.turn; });
  candidates.resize(std::min<std::size_t>(candidates.size(), count));
  std::vector<Eigen::Vector3f> sample;
  sample.reserve(candidates.size());
  for (const Candidate& c : candidates) sample.push_back(points_[c.index]);
  return sample;
}

}  // namespace evit
