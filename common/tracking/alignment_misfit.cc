#include "common/tracking/alignment_misfit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/tracking/image_patches.h"
#include "common/tracking/plane_term.h"

namespace evit {
namespace {

constexpr int kFewest = 8;               // points in a patch
constexpr double kLeastCurvature = 0.1;  // of the median patch's, by point: below it the bottom is anywhere
constexpr double kFarthest = 5;  // pixels: beyond some widths of a valley the step is no measure any more

struct Patch {
  int n = 0;
  double depth = 0;  // sum, m
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();
};

struct Valley {
  double curvature;  // by point
  double step;       // pixels
  double depth;      // m
};

std::vector<Patch> SumPatches(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body) {
  const SE3 T_camera_map = settings.T_camera_body * T_map_body.Inverse();
  const ImagePatches places(settings.camera());
  std::vector<Patch> patches(places.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d p = T_camera_map * points.At(k);
    Eigen::Vector2d pixel;
    if (!settings.camera().Project(p, &pixel) || !settings.camera().Contains(pixel)) continue;
    const PlaneTerm term = PlaneTermAt(settings, field, pixel);
    Patch& patch = patches[places.At(pixel)];
    ++patch.n;
    patch.depth += p.z();
    patch.gradient += term.gradient;
    patch.curvature += term.curvature;
  }
  return patches;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

AlignmentMisfit MeasureMisfit(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body) {
  std::vector<Valley> valleys;
  std::vector<double> curvatures;
  for (const Patch& patch : SumPatches(settings, field, points, T_map_body)) {
    if (patch.n < kFewest) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(patch.curvature);
    const double curvature = solver.eigenvalues()[1];
    if (curvature <= 0) continue;
    const double step = std::abs(solver.eigenvectors().col(1).dot(patch.gradient)) / curvature;
    valleys.push_back({curvature / patch.n, std::min(step, kFarthest), patch.depth / patch.n});
    curvatures.push_back(valleys.back().curvature);
  }
  AlignmentMisfit misfit;
  if (valleys.empty()) return misfit;
  const double least = kLeastCurvature * Median(curvatures);
  std::vector<double> steps, depths;
  for (const Valley& valley : valleys) {
    if (valley.curvature < least) continue;
    steps.push_back(valley.step);
    depths.push_back(valley.depth);
  }
  misfit.n_patches = static_cast<int>(steps.size());
  misfit.offset_px = Median(steps);
  misfit.metres_per_px = Median(depths) * 2 / (settings.camera().fx + settings.camera().fy);
  return misfit;
}

}  // namespace evit
