#include "common/photometric/view_renderer.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/parallel/parallel_for.h"

namespace evit {

Camera ViewCamera(const Camera& camera, double margin) {
  Camera view;
  view.width = camera.width / 2;
  view.height = camera.height / 2;
  const double scale = 1 / (1 + margin);
  const double x = 0.5 * (view.width - 1), y = 0.5 * (view.height - 1);
  view.fx = 0.5 * scale * camera.fx;
  view.fy = 0.5 * scale * camera.fy;
  view.cx = scale * (0.5 * (camera.cx - 0.5) - x) + x;
  view.cy = scale * (0.5 * (camera.cy - 0.5) - y) + y;
  return view;
}

void ViewRenderer::Render(const ViewQuery& query, PhotometricView* view) {
  const PaddedImage image{query.camera.width, query.camera.height};
  const std::size_t n = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  view->query = query;
  view->log_intensity.assign(n, 0);
  view->inverse_depth.assign(n, 0);
  const float side = cells_.spacing() * static_cast<float>(std::max(query.camera.fx, query.camera.fy));
  const int threads = std::max(1, threads_);
  splats_.resize(static_cast<std::size_t>(threads));
  depth_.resize(image.size());
  sums_.numbers.resize(SplatSums::kNumbers * n);
  // Of the map first, then of the image: all splats are there before the first row is drawn.
  const auto in_rows = [&](const std::function<void(ImageRows)>& work) {
    ParallelFor(threads, threads, [&](int k) {
      work({k * image.height / threads, (k + 1) * image.height / threads});
    });
  };
  ParallelFor(threads, threads, [&](int k) {
    const auto part = static_cast<std::size_t>(k);
    cells_.Project(query, part, splats_.size(), &splats_[part]);
  });
  in_rows([&](ImageRows rows) { FillDepth(splats_, 0.75F * side, image, rows, &depth_); });
  scratch_ = depth_;
  in_rows([&](ImageRows rows) {
    CloseLeaks(image, rows);
    BlendSplats(splats_, 1.2F * side, image, depth_, rows, &sums_);
    TakeMeans(image, rows, view);
  });
  FillHoles(query.camera, view);
}

// A pixel amid a nearer surface, at least six of its eight neighbours, is a gap between that surface's
// points. From the depths before, in scratch_.
void ViewRenderer::CloseLeaks(const PaddedImage& image, ImageRows rows) {
  const std::ptrdiff_t stride = image.stride();
  for (int y = std::max(1, rows.begin); y < std::min(rows.end, image.height - 1); ++y) {
    for (int x = 1; x + 1 < image.width; ++x) {
      const std::size_t k = static_cast<std::size_t>(y * stride + x);
      const float limit = scratch_[k] == kNoDepth ? kNoDepth : scratch_[k] * (1 - 2 * kSameShare) - kSame;
      int nearer = 0;
      float farthest = 0;
      for (int v = -1; v <= 1; ++v) {
        for (int u = -1; u <= 1; ++u) {
          const float other = scratch_[k + static_cast<std::size_t>(v * stride + u)];
          if (other >= limit) continue;
          ++nearer;
          farthest = std::max(farthest, other);
        }
      }
      if (nearer >= 6) depth_[k] = farthest;
    }
  }
}

// Weighted mean of the points on the surface that each pixel sees.
void ViewRenderer::TakeMeans(const PaddedImage& image, ImageRows rows, PhotometricView* view) const {
  for (int y = rows.begin; y < rows.end; ++y) {
    const float* pixel = sums_.Row(y, image.width);
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    for (std::size_t k = row; k < row + static_cast<std::size_t>(image.width);
         ++k, pixel += SplatSums::kNumbers) {
      const float weight = pixel[0];
      if (!(weight > 1e-3F)) continue;
      view->log_intensity[k] = std::log(pixel[1] / weight + dark_);
      view->inverse_depth[k] = pixel[2] / weight;
    }
  }
}

// Twice: pixels that see nothing amid at least five that do get their mean.
void ViewRenderer::FillHoles(const Camera& camera, PhotometricView* view) {
  const int width = camera.width, height = camera.height;
  for (int round = 0; round < 2; ++round) {
    scratch_ = view->inverse_depth;
    for (int y = 1; y + 1 < height; ++y) {
      for (int x = 1; x + 1 < width; ++x) {
        const std::size_t k = static_cast<std::size_t>(y) * width + x;
        if (scratch_[k] > 0) continue;
        int seen = 0;
        float mean = 0, inverse = 0;
        for (int v = -1; v <= 1; ++v) {
          for (int u = -1; u <= 1; ++u) {
            const std::size_t j = k + static_cast<std::ptrdiff_t>(v) * width + u;
            if (!(scratch_[j] > 0)) continue;
            ++seen;
            mean += view->log_intensity[j];
            inverse += view->inverse_depth[j];
          }
        }
        if (seen < 5) continue;
        view->log_intensity[k] = mean / static_cast<float>(seen);
        view->inverse_depth[k] = inverse / static_cast<float>(seen);
      }
    }
  }
}

}  // namespace evit
