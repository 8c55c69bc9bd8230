#include "common/mapping/depth_votes.h"

#include <algorithm>

namespace evit {
namespace {

constexpr int kMinSteps = 8, kMaxSteps = 1024;
constexpr int kBorderPx = 4;

}  // namespace

DepthSteps::DepthSteps(double low, double high, const std::vector<StereoNeighbour>& neighbours) : low(low) {
  double largest = 0;  // pixels that the inverse depth 1/m makes
  for (const StereoNeighbour& n : neighbours)
    largest = std::max(largest, n.t().norm() * std::max(n.view().camera.fx, n.view().camera.fy));
  if (largest <= 0) return;
  steps = std::clamp(static_cast<int>((high - low) * largest) + 2, kMinSteps, kMaxSteps);
  step = (high - low) / (steps - 1);
}

void DepthVotes::Clear() {
  std::fill(votes_.begin(), votes_.end(), 0);
  std::fill(seen_.begin(), seen_.end(), 0);
}

void DepthVotes::Add(const StereoNeighbour& neighbour) {
  const Camera& camera = neighbour.view().camera;
  const EdgeImage& edges = neighbour.view().edges;
  const auto width = static_cast<float>(edges.width() - kBorderPx - 1);
  const auto height = static_cast<float>(edges.height() - kBorderPx - 1);
  const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  const float cx = static_cast<float>(camera.cx) + 0.5F, cy = static_cast<float>(camera.cy) + 0.5F;
  const Eigen::Vector3f first = neighbour.At(steps_.low).cast<float>(),
                        move = (steps_.step * neighbour.t()).cast<float>();
  for (int k = 0; k < steps_.steps; ++k) {
    const auto f = static_cast<float>(k);
    const float z = first.z() + f * move.z();
    if (z < 0.05F) continue;
    const float x = fx * (first.x() + f * move.x()) / z + cx, y = fy * (first.y() + f * move.y()) / z + cy;
    if (!(x >= kBorderPx && y >= kBorderPx && x < width && y < height)) continue;
    ++seen_[k];
    votes_[k] += edges.Vote(static_cast<int>(x), static_cast<int>(y), neighbour.bin());
  }
}

std::array<DepthPeak, DepthVotes::kPeaks> DepthVotes::Peaks(int min_views, float min_share) {
  const int steps = steps_.steps;
  for (int k = 0; k < steps; ++k) {
    share_[k] =
        seen_[k] >= min_views ? static_cast<float>(votes_[k]) / static_cast<float>(2 * seen_[k]) : 0.0F;
  }
  std::array<DepthPeak, kPeaks> peaks{};
  // A plateau counts once, by its middle.
  for (int k = 0; k < steps;) {
    int end = k + 1;
    while (end < steps && share_[end] == share_[k]) ++end;
    const bool peak = share_[k] >= min_share && (k == 0 || share_[k - 1] < share_[k]) &&
                      (end == steps || share_[end] < share_[k]);
    if (peak && share_[k] > peaks.back().share) {
      peaks.back() = {share_[k], steps_.low + steps_.step * 0.5 * (k + end - 1)};
      std::stable_sort(peaks.begin(), peaks.end(),
                       [](const DepthPeak& a, const DepthPeak& b) { return a.share > b.share; });
    }
    k = end;
  }
  return peaks;
}

}  // namespace evit
