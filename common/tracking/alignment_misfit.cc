#include "common/tracking/alignment_misfit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/tracking/batch_samples.h"
#include "common/tracking/image_patches.h"

namespace evit {
namespace {

constexpr int kFewest = 8;               // points in a patch
constexpr double kLeastCurvature = 0.1;  // of the median patch's, by point: below it the bottom is anywhere
constexpr double kFarthest = 5;  // pixels: beyond some widths of a valley the step measures nothing any more

struct Patch {
  int n = 0;
  double depth = 0;  // sum, m
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();  // its lower triangle
};

struct Valley {
  double curvature;  // by point
  double step;       // pixels
  double depth;      // m
};

std::vector<Patch> SumPatches(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body) {
  const PlaneSamples samples =
      SamplePlane(BatchAlignment(settings, field, 0, points, T_map_body), points.local());
  const ImagePatches places(settings.camera());
  std::vector<Patch> patches(places.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (samples.inside[k] == 0) continue;
    Patch& patch = patches[places.At(samples.u[k], samples.v[k])];
    ++patch.n;
    patch.depth += samples.depth[k];
    patch.gradient += Eigen::Vector2d(samples.gu[k], samples.gv[k]);
    patch.curvature(0, 0) += samples.cuu[k];
    patch.curvature(1, 0) += samples.cuv[k];
    patch.curvature(1, 1) += samples.cvv[k];
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
