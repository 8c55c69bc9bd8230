#include "common/tracking/localizer.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>

#include "common/tracking/alignment_significance.h"
#include "common/tracking/ceres_factors.h"
#include "common/tracking/pose_manifold.h"

namespace evit {
namespace {

void Judge(const AlignmentSettings& settings, const SurfaceField& field, const AlignmentPoints& points,
           LocalizerResult* result) {
  const AlignmentVerdict verdict = JudgeAlignment(settings, field, points, result->T_map_body);
  result->quality = verdict.quality;
  result->significance = verdict.significance;
}

LocalizerResult LocalizeFrom(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& start, const Matrix6d& information,
                             int levels, int max_iterations) {
  BodyState state;
  state.T_map_body = start;
  StateBlocks blocks = ToBlocks(state);
  StatePrior prior;
  prior.mean = state;
  prior.information.topLeftCorner<6, 6>() = information;
  LocalizerResult result;
  for (int level = std::min(levels, field.levels()) - 1; level >= 0; --level) {
    ceres::Problem problem;
    problem.AddParameterBlock(blocks.pose.data(), 7, new PoseManifold);
    problem.AddResidualBlock(new EventAlignmentFactor(&settings, &field, level, &points), nullptr,
                             blocks.pose.data());
    problem.AddResidualBlock(new PriorFactor(prior), nullptr, blocks.pose.data(), blocks.motion.data());
    problem.SetParameterBlockConstant(blocks.motion.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = max_iterations;
    options.function_tolerance = 1e-5;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    result.iterations += static_cast<int>(summary.iterations.size());
  }
  result.T_map_body = PoseFromBlock(blocks.pose.data());
  result.T_map_body.q.normalize();
  Judge(settings, field, points, &result);
  return result;
}

}  // namespace

Matrix6d InformationOf(const StartRange& range) {
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1 / (range.position * range.position));
  information.diagonal().tail<3>().setConstant(1 / (range.rotation * range.rotation));
  return information;
}

LocalizerResult Localize(const AlignmentSettings& settings, const SurfaceField& field,
                         const AlignmentPoints& points, const SE3& start, const StartRange& range,
                         int max_iterations) {
  return LocalizeFrom(settings, field, points, start, InformationOf(range), range.levels, max_iterations);
}

LocalizerResult LocalizeBest(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& start, const StartRange& range) {
  return LocalizeBest(settings, field, points, start, InformationOf(range), range.levels);
}

LocalizerResult LocalizeBest(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& start, const Matrix6d& information,
                             int levels) {
  LocalizerResult best;
  best.T_map_body = start;
  Judge(settings, field, points, &best);
  int iterations = 0;
  for (int depth = 1; depth <= std::min(levels, field.levels()); ++depth) {
    const LocalizerResult fit =
        LocalizeFrom(settings, field, points, start, information, depth, kLocalizerIterations);
    iterations += fit.iterations;
    if (fit.significance > best.significance) best = fit;
  }
  best.iterations = iterations;
  return best;
}

}  // namespace evit
