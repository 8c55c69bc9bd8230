#include "common/diagnosis/hole_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "common/diagnosis/excerpt_views.h"
#include "common/overlap/pixel_set.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kUsual = 0.2;  // share of what fires that is far from every point: mean over the views
constexpr double kUsualInWorst = 1.0 / 3;  // and over the three views in which it is most
constexpr double kFarShare = 0.025;        // of the image's width; but at least:
constexpr double kFar = 12;                // pixels
constexpr int kCompany = 3;                // of the eight pixels around; noise is alone
constexpr std::int64_t kFewest = 50;       // such pixels that a view needs

PixelSet MapPixels(const Rig& rig, const MapView& view) {
  PixelSet pixels(rig.camera.width, rig.camera.height);
  const SE3 T_camera_map = (view.T_map_body * rig.T_body_camera).Inverse();
  for (const Eigen::Vector3f& p : view.points) {
    Eigen::Vector2d at;
    if (rig.camera.Project(T_camera_map * p.cast<double>(), &at))
      pixels.Add(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
  }
  return pixels;
}

bool InCompany(const PixelSet& fired, int x, int y) {
  int n = -1;  // itself
  for (int v = -1; v <= 1; ++v)
    for (int u = -1; u <= 1; ++u) n += fired.Has(x + u, y + v) ? 1 : 0;
  return n >= kCompany;
}

// The share of a view's edges that no point is near to; -1: too few fire.
double Unexplained(const Rig& rig, const MapView& view, const NearestPixel& near) {
  const PixelSet points = MapPixels(rig, view);
  std::int64_t n = 0, far = 0;
  Eigen::Vector2d offset;
  for (int y = 0; y < view.fired.height(); ++y) {
    for (int x = 0; x < view.fired.width(); ++x) {
      if (!view.fired.Has(x, y) || !InCompany(view.fired, x, y)) continue;
      ++n, far += near.Find(points, {x, y}, &offset) ? 0 : 1;
    }
  }
  return n < kFewest ? -1 : static_cast<double>(far) / static_cast<double>(n);
}

}  // namespace

Finding CheckHoles(const MapIndex& map, const World& world, const EventExcerpts& excerpts) {
  MapViewOptions options;
  options.max_points = 200'000;  // all
  const double reach = std::max(kFar, kFarShare * world.rig.camera.width);
  const NearestPixel near(reach);
  std::vector<double> shares;
  double worst = 0;
  Utime at = 0;
  for (const MapView& view : ViewsOf(map, world, excerpts, 1, options)) {
    const double share = Unexplained(world.rig, view, near);
    if (share < 0) continue;
    shares.push_back(share);
    if (share > worst) worst = share, at = view.utime;
  }
  const auto n = static_cast<double>(shares.size());
  if (shares.size() < 4) return Good("map-holes", "too few views to tell");
  double mean = 0, squares = 0;
  for (const double share : shares) mean += share / n;
  for (const double share : shares) squares += (share - mean) * (share - mean);
  const double error = std::sqrt(squares / (n * (n - 1)));
  const std::string figure =
      FormatText("%.0f +-%.0f %% of the edges that fire have no point of the map within %.0f pixels",
                 100 * mean, 100 * error, reach);
  // A camera that passes by a hole sees it in some views only.
  std::partial_sort(shares.begin(), shares.begin() + 3, shares.end(), std::greater<>());
  const double in_worst = (shares[0] + shares[1] + shares[2]) / 3;
  if (mean - 2 * error > kUsual || in_worst > kUsualInWorst) {
    return {"map-holes", mean > 0.5 ? Severity::kError : Severity::kWarning, figure,
            FormatText("Parts of the map are missing: much of what the camera sees is not in it, most at "
                       "%.3f s (%.0f %%).",
                       ToSeconds(at), 100 * worst),
            "`evit map check` draws map and events on each other; add pictures of the missing part to `evit "
            "map build`"};
  }
  return Good("map-holes", figure);
}

}  // namespace evit::diagnosis
