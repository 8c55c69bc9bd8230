#include "common/tracking/event_alignment.h"

#include <cmath>
#include <numeric>
#include <vector>

#include "common/tracking/batch_alignment.h"

namespace evit {

AlignmentSettings MakeAlignmentSettings(const Rig& rig, const WindowOptions& options) {
  AlignmentSettings settings;
  settings.set_camera(rig.camera);
  settings.T_camera_body = rig.T_body_camera.Inverse();
  settings.image_sigma = options.image_sigma;
  settings.kernel = {options.kernel, options.robust_scale / options.image_sigma};
  return settings;
}

AlignmentTerm EvaluateAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                                const AlignmentPoints& points, const SE3& T_map_body, bool derivatives) {
  AlignmentSums sums;
  SumAlignment(BatchAlignment(settings, field, level, points, T_map_body), points.local(), derivatives,
               &sums);
  AlignmentTerm term;
  term.cost = 0.5 * sums.rho;
  if (!derivatives) return term;
  const auto total = [](const float* lanes) { return std::accumulate(lanes, lanes + kLanes, 0.0); };
  for (int i = 0, at = 0; i < 6; ++i) {
    term.gradient[i] = total(sums.gradient[i]);
    for (int j = i; j < 6; ++j) term.hessian(i, j) = term.hessian(j, i) = total(sums.hessian[at++]);
  }
  // The position of the sums is in the body frame.
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Identity();
  turn.topLeftCorner<3, 3>() = T_map_body.R();
  term.hessian = turn * term.hessian * turn.transpose();
  term.gradient = turn * term.gradient;
  return term;
}

AlignmentQuality MeasureAlignment(const AlignmentSettings& settings, const SurfaceField& field,
                                  const AlignmentPoints& points, const SE3& T_map_body, double shift) {
  const std::size_t room = points.size() + kLanes;
  std::vector<float> value(room), beside(room);
  std::vector<std::int32_t> inside(room);
  SampleBeside(BatchAlignment(settings, field, 0, points, T_map_body), points.local(),
               static_cast<float>(settings.camera().width), static_cast<float>(settings.camera().height),
               static_cast<float>(shift), value.data(), beside.data(), inside.data());
  AlignmentQuality quality;
  double sum = 0, shifted = 0;
  int inliers = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (inside[k] == 0) continue;
    ++quality.n_points;
    sum += value[k];
    shifted += beside[k];
    inliers += value[k] < 127.5F ? 1 : 0;
  }
  if (quality.n_points > 0) {
    quality.mean_value = sum / quality.n_points;
    quality.shifted_value = shifted / quality.n_points;
    quality.inlier_share = static_cast<double>(inliers) / quality.n_points;
  }
  return quality;
}

}  // namespace evit
