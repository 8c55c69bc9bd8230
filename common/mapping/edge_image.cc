#include "common/mapping/edge_image.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evit {
namespace {

constexpr float kNear = 0.8F, kWide = 1.6F;                // pixels
constexpr float kBinReach = 50.0F * 3.14159265F / 180.0F;  // rad: bins whose middle is as close get the edge

}  // namespace

EdgeImage::EdgeImage(int width, int height, std::vector<EdgePixel> edges, bool has_sides)
    : width_(width),
      height_(height),
      columns_((width + kCell - 1) / kCell),
      rows_((height + kCell - 1) / kCell),
      has_sides_(has_sides),
      edges_(std::move(edges)) {
  FillMasks();
  SortIntoCells();
}

int EdgeImage::BinOf(const Eigen::Vector2f& normal) {
  const float turn = std::atan2(normal.y(), normal.x()) / (2 * static_cast<float>(M_PI));  // -0.5 .. 0.5
  return static_cast<int>(std::lround(turn * kBins) + kBins) % kBins;
}

void EdgeImage::FillMasks() {
  masks_.assign(static_cast<std::size_t>(width_) * height_, 0);
  for (const EdgePixel& e : edges_) {
    const float angle = std::atan2(e.normal.y(), e.normal.x());
    unsigned bins = 0;
    for (int bin = 0; bin < kBins; ++bin) {
      const float off = std::remainder(angle - static_cast<float>(2 * M_PI) * static_cast<float>(bin) / kBins,
                                       static_cast<float>(has_sides_ ? 2 * M_PI : M_PI));
      if (std::abs(off) <= kBinReach) bins |= 1U << bin;
    }
    const int left = std::max(0, static_cast<int>(std::ceil(e.pixel.x() - kWide)));
    const int right = std::min(width_ - 1, static_cast<int>(std::floor(e.pixel.x() + kWide)));
    const int top = std::max(0, static_cast<int>(std::ceil(e.pixel.y() - kWide)));
    const int bottom = std::min(height_ - 1, static_cast<int>(std::floor(e.pixel.y() + kWide)));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const float distance2 =
            (Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - e.pixel).squaredNorm();
        if (distance2 > kWide * kWide) continue;
        masks_[static_cast<std::size_t>(y) * width_ + x] |=
            static_cast<std::uint16_t>(distance2 <= kNear * kNear ? bins | bins << kBins : bins);
      }
    }
  }
}

void EdgeImage::SortIntoCells() {
  const auto cell = [&](const EdgePixel& e) {
    return CellOf(e.pixel.y(), rows_) * columns_ + CellOf(e.pixel.x(), columns_);
  };
  std::stable_sort(edges_.begin(), edges_.end(),
                   [&](const EdgePixel& a, const EdgePixel& b) { return cell(a) < cell(b); });
  begin_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  for (const EdgePixel& e : edges_) ++begin_[cell(e) + 1];
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
}

const EdgePixel* EdgeImage::Match(const Query& query) const {
  const EdgePixel* best = nullptr;
  float best_cost = 0;
  VisitNear(query.pixel, std::hypot(query.radius, query.slack), [&](const EdgePixel& e) {
    const float cosine = e.normal.dot(query.normal);
    if ((has_sides_ ? cosine : std::abs(cosine)) < query.min_cosine) return;
    const Eigen::Vector2f off = query.pixel - e.pixel;
    const float across = std::abs(off.dot(e.normal));
    const float along = std::abs(off.x() * e.normal.y() - off.y() * e.normal.x());
    if (across > query.radius || along > query.slack) return;
    const float cost = across + 0.25F * along;  // of one line's pixels the one beside
    if (best == nullptr || cost < best_cost) best = &e, best_cost = cost;
  });
  return best;
}

}  // namespace evit
