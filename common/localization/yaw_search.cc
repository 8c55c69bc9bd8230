#include "common/localization/yaw_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/parallel/parallel_for.h"
#include "common/simd/lanes.h"

namespace evit {
namespace {

using namespace panorama;  // NOLINT(google-build-using-namespace): this file is about nothing else

constexpr int kFewestEdges = 30;  // edges in sight: fewer say nothing
constexpr int kPeaks = 3;         // yaws of one place
constexpr int kApart = 3;         // yaw bins between them

struct Sums {
  std::array<std::int16_t, kColumns> gain, sight;
};

EVIT_MULTIVERSION void AddRow(const std::int16_t* gain, const std::int16_t* sight, std::int16_t* gains,
                              std::int16_t* sights) {
  for (int s = 0; s < kColumns; ++s) {
    gains[s] = static_cast<std::int16_t>(gains[s] + gain[s]);
    sights[s] = static_cast<std::int16_t>(sights[s] + sight[s]);
  }
}

// The best yaws of one place, to `out`.
void MatchPlace(const PlaceIndex& index, const PlaceIndex::Place& place, const EventPanorama& events,
                const std::function<bool(const Eigen::Vector3f&, double)>& allowed,
                std::vector<PlaceMatch>* out) {
  Sums sums;
  sums.gain.fill(0);
  sums.sight.fill(0);
  for (std::uint32_t k = place.begin; k < place.end; ++k) {
    const PlaceIndex::Edge edge = index.edges()[k];
    if (!events.InSight(edge.stacked_row)) continue;
    AddRow(events.Gain(edge.stacked_row, edge.column), events.Sight(edge.stacked_row, edge.column),
           sums.gain.data(), sums.sight.data());
  }
  std::array<double, kColumns> score;
  for (int s = 0; s < kColumns; ++s) {
    score[s] =
        sums.sight[s] < kFewestEdges ? 0 : sums.gain[s] / (events.sigma() * std::sqrt(1.0 * sums.sight[s]));
    if (allowed && score[s] > 0 && !allowed(place.at, kBin * s)) score[s] = 0;
  }
  for (int peak = 0; peak < kPeaks; ++peak) {
    const auto best = std::max_element(score.begin(), score.end());
    if (*best <= 0) return;
    const auto s = static_cast<int>(best - score.begin());
    out->push_back({place.at, kBin * s, *best});
    for (int d = -kApart; d <= kApart; ++d) score[(s + d) & (kColumns - 1)] = 0;
  }
}

bool Neighbours(const PlaceMatch& a, const PlaceMatch& b, double spacing) {
  const double yaw = std::remainder(a.yaw - b.yaw, 2 * kPi);
  return (a.at - b.at).cwiseAbs().maxCoeff() < 1.5 * spacing && std::abs(yaw) < 3.5 * kBin;
}

}  // namespace

std::vector<PlaceMatch> BestMatches(const PlaceIndex& index, const EventPanorama& events, std::size_t count,
                                    const std::function<bool(const Eigen::Vector3f&, double)>& allowed,
                                    int threads) {
  const int parts = std::max(1, threads);
  std::vector<std::vector<PlaceMatch>> found(parts);
  ParallelFor(parts, threads, [&](int part) {
    for (std::size_t k = part; k < index.places().size(); k += parts)
      MatchPlace(index, index.places()[k], events, allowed, &found[part]);
  });
  std::vector<PlaceMatch> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), [](const PlaceMatch& a, const PlaceMatch& b) {
    if (a.score != b.score) return a.score > b.score;
    for (int k = 0; k < 3; ++k)
      if (a.at[k] != b.at[k]) return a.at[k] < b.at[k];
    return a.yaw < b.yaw;
  });
  std::vector<PlaceMatch> best;
  for (const PlaceMatch& match : all) {
    if (best.size() == count) break;
    const bool known = std::any_of(
        best.begin(), best.end(), [&](const PlaceMatch& b) { return Neighbours(b, match, index.spacing()); });
    if (!known) best.push_back(match);
  }
  return best;
}

}  // namespace evit
