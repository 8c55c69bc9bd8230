#include "common/events/surface_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace evit {
namespace {

constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
constexpr int kTableSize = 4096;      // fits the first-level cache; a step is 0.15 % of the decay
constexpr double kSupportDecays = 2;  // a neighbour supports a pixel if it fired within so many decays

// The loops over rows: plain pointers that do not overlap, so that the compiler makes vectors of them;
// without branches, since whether a pixel has an event is hard to foretell.

void DistanceRow(const std::int32_t* __restrict a, const std::int32_t* __restrict b, std::ptrdiff_t n,
                 std::int32_t now, std::int32_t* __restrict out) {
  for (std::ptrdiff_t i = 0; i < n; ++i) out[i] = now - (a[i] > b[i] ? a[i] : b[i]);
}

void NearRow(const std::int32_t* __restrict d, int n, std::int32_t limit, std::uint8_t* __restrict out) {
  for (int x = 0; x < n; ++x) out[x] = d[x] <= limit ? 255 : 0;
}

/// `above`: first of three rows of near_, each n + 2 wide. out: 255 where a neighbour is near.
void SupportRow(const std::uint8_t* __restrict above, int n, std::uint8_t* __restrict column,
                std::uint8_t* __restrict out) {
  const std::uint8_t* __restrict here = above + n + 2;
  const std::uint8_t* __restrict below = here + n + 2;
  for (int x = 0; x < n + 2; ++x) column[x] = above[x] | here[x] | below[x];
  for (int x = 0; x < n; ++x) out[x] = column[x] | column[x + 2] | above[x + 1] | below[x + 1];
}

/// Places in the table; `none` beyond `max`.
void IndexRow(const std::int32_t* __restrict d, int n, std::int32_t max, int shift, std::int32_t none,
              std::int32_t* __restrict out) {
  for (int x = 0; x < n; ++x) out[x] = d[x] <= max ? d[x] >> shift : none;
}

void LookUpRow(const std::int32_t* __restrict index, const std::uint8_t* __restrict support, int n,
               const std::uint8_t* __restrict table, std::uint8_t* __restrict out) {
  for (int x = 0; x < n; ++x) out[x] = table[index[x]];
  for (int x = 0; x < n; ++x) out[x] &= support[x];
}

}  // namespace

double VisibleUs(double decay_us, double truncation) {
  // Below half a grey level T rounds to 0 in any case.
  return decay_us * std::log(255 / std::clamp(truncation, 0.5, 255.0));
}

SurfaceRenderer::SurfaceRenderer(int width, int height, const config::Surface& settings)
    : width_(width),
      height_(height),
      truncation_(settings.truncation()),
      sigma_(settings.blur_sigma_px()),
      split_(settings.split_polarity()),
      support_(settings.support_filter()),
      image_(height, width, CV_8UC1) {
  for (auto& plane : distances_) plane.resize(std::size_t(width) * height);
  near_.resize(std::size_t(width + 2) * (height + 2));
}

std::vector<SurfaceRenderer::Image> SurfaceRenderer::Render(const ActiveEventSurface& surface,
                                                            const View& view) {
  MakeTable(view.decay_us);
  std::vector<Image> images;
  if (!split_) {
    FillDistances(surface, view, true, true, &distances_[0]);
    if (support_) FindNear(distances_[0], view.decay_us);
    images.push_back(Draw(distances_[0]));
    return images;
  }
  FillDistances(surface, view, true, false, &distances_[0]);
  FillDistances(surface, view, false, true, &distances_[1]);
  if (support_) {
    std::vector<std::int32_t> nearest(distances_[0].size());
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      nearest[i] = std::min(distances_[0][i], distances_[1][i]);
    }
    FindNear(nearest, view.decay_us);
  }
  images.push_back(Draw(distances_[1]));
  images.push_back(Draw(distances_[0]));
  return images;
}

void SurfaceRenderer::FillDistances(const ActiveEventSurface& surface, const View& view, bool darker,
                                    bool brighter, std::vector<std::int32_t>* distances) const {
  const std::int32_t now = surface.Relative(view.t);
  const std::int32_t* const a = surface.stamps(darker ? 0 : 1);
  const std::int32_t* const b = surface.stamps(brighter ? 1 : 0);
  std::int32_t* const out = distances->data();
  const auto pixels = static_cast<std::ptrdiff_t>(distances->size());
  DistanceRow(a, b, pixels, now, out);
  for (std::size_t i = view.begin; view.after != nullptr && i < view.end; ++i) {
    const EventArray& e = *view.after;
    if (!(e.p[i] != 0 ? brighter : darker) || e.x[i] >= width_ || e.y[i] >= height_) continue;
    std::int32_t* const d = out + e.y[i] * std::ptrdiff_t{width_} + e.x[i];
    *d = static_cast<std::int32_t>(std::min<Utime>(*d, e.t[i] - view.t));
  }
  if (view.ignored != nullptr) {
    for (const std::int32_t pixel : *view.ignored) out[pixel] = kFar;
  }
}

void SurfaceRenderer::FindNear(const std::vector<std::int32_t>& distances, double decay_us) {
  const auto limit = static_cast<std::int32_t>(kSupportDecays * decay_us);
  for (int y = 0; y < height_; ++y) {
    NearRow(distances.data() + y * std::ptrdiff_t{width_}, width_, limit,
            near_.data() + (y + 1) * std::ptrdiff_t{width_ + 2} + 1);
  }
}

void SurfaceRenderer::MakeTable(double decay_us) {
  max_distance_ = static_cast<std::int32_t>(std::min(VisibleUs(decay_us, truncation_), 5e8));
  shift_ = 0;
  while ((max_distance_ >> shift_) >= kTableSize) ++shift_;
  const std::size_t size = (max_distance_ >> shift_) + 1;
  table_.assign(size + 1, 0);  // the last for pixels without an event
  const double half_step = 0.5 * ((1 << shift_) - 1);
  for (std::size_t i = 0; i < size; ++i) {
    const double distance = static_cast<double>(i << shift_) + half_step;
    table_[i] = static_cast<std::uint8_t>(std::lround(255 * std::exp(-distance / decay_us)));
  }
}

SurfaceRenderer::Image SurfaceRenderer::Draw(const std::vector<std::int32_t>& distances) {
  const std::ptrdiff_t stride = width_ + 2;
  std::vector<std::uint8_t> column(stride), support(width_, 255);
  std::vector<std::int32_t> index(width_);
  for (int y = 0; y < height_; ++y) {
    if (support_) SupportRow(near_.data() + y * stride, width_, column.data(), support.data());
    IndexRow(distances.data() + y * std::ptrdiff_t{width_}, width_, max_distance_, shift_,
             static_cast<std::int32_t>(table_.size()) - 1, index.data());
    LookUpRow(index.data(), support.data(), width_, table_.data(), image_.ptr<std::uint8_t>(y));
  }
  Image image(std::size_t(width_) * height_);
  cv::Mat drawn(height_, width_, CV_8UC1, image.data());
  if (sigma_ > 0) {
    cv::GaussianBlur(image_, drawn, cv::Size(), sigma_);
  } else {
    image_.copyTo(drawn);
  }
  for (std::uint8_t& value : image) value = static_cast<std::uint8_t>(255 - value);
  return image;
}

}  // namespace evit
