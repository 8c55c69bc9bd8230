#include "common/tracking/event_alignment.h"

#include <Eigen/Eigenvalues>

#include "common/tracking/batch_alignment.h"
#include "common/tracking/batch_samples.h"

namespace evit {

AlignmentSettings MakeAlignmentSettings(const Rig& rig, const WindowOptions& options) {
  AlignmentSettings settings;
  settings.set_camera(rig.camera);
  settings.T_camera_body = rig.T_body_camera.Inverse();
  settings.image_sigma = options.image_sigma;
  settings.kernel = {options.kernel, options.robust_scale / options.image_sigma};
  return settings;
}

namespace {

AlignmentTerm TermOf(const AlignmentSums& sums, const SE3& T_map_body) {
  AlignmentTerm term;
  term.cost = 0.5 * sums.rho;
  for (int i = 0; i < 6; ++i) term.gradient[i] = SumLanes(sums.gradient[i]);
  term.gradient.head<3>() = (T_map_body.R() * term.gradient.head<3>()).eval();
  term.hessian = HessianOfLanes(sums.hessian, T_map_body);
  return term;
}

}  // namespace

AlignmentTerm EvaluateAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                                const AlignmentPoints& points, const SE3& T_map_body, bool derivatives) {
  AlignmentSums sums;
  SumAlignment(BatchAlignment(settings, field, level, points, T_map_body), points.local(),
               derivatives ? AlignmentPart::kSafe : AlignmentPart::kCost, &sums);
  return TermOf(sums, T_map_body);
}

AlignmentTerm EvaluateAlignmentExactly(const AlignmentSettings& settings, const SurfaceField& field,
                                       const AlignmentPoints& points, const SE3& T_map_body, Matrix6d* bend) {
  AlignmentSums sums;
  SumAlignment(BatchAlignment(settings, field, 0, points, T_map_body), points.local(), AlignmentPart::kExact,
               &sums);
  AlignmentTerm term = TermOf(sums, T_map_body);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(term.hessian);
  const auto with = [&solver](const Vector6d& eigenvalues) -> Matrix6d {
    return solver.eigenvectors() * eigenvalues.asDiagonal() * solver.eigenvectors().transpose();
  };
  term.hessian = with(solver.eigenvalues().cwiseMax(0));
  if (bend != nullptr) *bend = with(solver.eigenvalues().cwiseAbs());
  return term;
}

AlignmentQuality QualityOf(const BesideSamples& samples, std::size_t n) {
  AlignmentQuality quality;
  double sum = 0, shifted = 0;
  int inliers = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (samples.inside[k] == 0) continue;
    ++quality.n_points;
    sum += samples.value[k];
    shifted += samples.beside[k];
    inliers += samples.value[k] < 127.5F ? 1 : 0;
  }
  if (quality.n_points > 0) {
    quality.mean_value = sum / quality.n_points;
    quality.shifted_value = shifted / quality.n_points;
    quality.inlier_share = static_cast<double>(inliers) / quality.n_points;
  }
  return quality;
}

AlignmentQuality MeasureAlignment(const AlignmentSettings& settings, const SurfaceField& field,
                                  const AlignmentPoints& points, const SE3& T_map_body, double shift) {
  return QualityOf(SampleBeside(BatchAlignment(settings, field, 0, points, T_map_body), points.local(),
                                static_cast<float>(shift)),
                   points.size());
}

}  // namespace evit
