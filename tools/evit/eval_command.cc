#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/evaluation/consistency.h"
#include "common/evaluation/trajectory_error.h"
#include "common/evaluation/trajectory_pairs.h"
#include "common/geometry/degrees.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/pictures/consistency_plot.h"
#include "tools/run/tracked_time.h"

namespace evit::commands {
namespace {

struct EvalOptions {
  std::string truth, estimate, covariance, plot;
  bool json = false;
};

struct Row {
  const char* name;
  Alignment alignment;
};
constexpr Row kRows[] = {{"none", Alignment::kNone},
                         {"first pair", Alignment::kFirstPair},
                         {"Umeyama", Alignment::kUmeyama},
                         {"with scale", Alignment::kScaled}};

nlohmann::json ToJson(const TrajectoryError& e) {
  if (!e.scored()) return nullptr;
  const auto degrees = [&e](double angle) {
    return e.oriented ? nlohmann::json(kDegreesPerRadian * angle) : nlohmann::json();
  };
  return {{"pairs", e.n_pairs},
          {"position_rmse_cm", 100 * e.position_rmse},
          {"orientation_rmse_deg", degrees(e.orientation_rmse)},
          {"position_max_cm", 100 * e.position_max},
          {"orientation_max_deg", degrees(e.orientation_max)}};
}

nlohmann::json ToJson(const Nees& nees) {
  return {{"pairs", nees.n},   {"dof", nees.dof},       {"mean_per_dof", nees.mean_per_dof()},
          {"mean", nees.mean}, {"median", nees.median}, {"share_within_95", nees.share_in_95}};
}

nlohmann::json ToJson(const Consistency& c) {
  return {{"position_nees", ToJson(c.position)},
          {"orientation_nees", ToJson(c.orientation)},
          {"pose_nees", ToJson(c.pose)},
          {"poses_without_covariance", c.without_covariance}};
}

void PrintCell(const TrajectoryError& e) {
  if (!e.scored()) {
    std::printf("  %16s", "-");
  } else if (!e.oriented) {
    std::printf("  %7.2f / %6s", 100 * e.position_rmse, "-");
  } else {
    std::printf("  %7.2f / %6.2f", 100 * e.position_rmse, kDegreesPerRadian * e.orientation_rmse);
  }
}

// What an estimate is worth against a truth.
struct Evaluation {
  Trajectory truth, estimate;
  TrajectoryError whole, relative;  // without alignment; over 1 s
  std::string unscored;             // parts of the run that are not, and why; may be empty
  std::optional<Consistency> consistency;
};

Evaluation Evaluate(const EvalOptions& o) {
  Evaluation e;
  e.truth = ReadTrajectory(o.truth);
  e.estimate = ReadTrajectory(o.estimate);
  e.whole = AbsoluteError(e.truth, e.estimate, Alignment::kNone);
  if (!e.whole.scored())
    throw std::runtime_error(o.estimate + " against " + o.truth + ": " +
                             TooFewPairsText(e.truth, e.estimate));
  e.unscored = UnscoredText(e.truth, e.estimate);
  e.relative = RelativeError(e.truth, e.estimate, kMicrosPerSecond);
  if (o.covariance.empty()) return e;
  e.consistency = ConsistencyOf(e.truth, e.estimate, ReadCovariances(o.covariance));
  if (e.consistency->pose.n == 0) {
    throw std::runtime_error(o.covariance + " has no covariance for the poses of " + o.estimate +
                             "; are they from the same run?");
  }
  return e;
}

void PrintJson(const EvalOptions& o, const Evaluation& e) {
  nlohmann::json out{{"truth", o.truth},
                     {"estimate", o.estimate},
                     {"coverage", run::Coverage(e.estimate, run::BreaksOf(e.estimate, {}),
                                                ToSeconds(e.truth.back().t - e.truth.front().t))},
                     {"reached", e.whole.reached},
                     {"poses", e.estimate.size()},
                     {"not_scored", e.unscored}};
  if (e.consistency) out["consistency"] = ToJson(*e.consistency);
  for (const Row& row : kRows) {
    nlohmann::json& j = out["ate"][row.name];
    j["all"] = ToJson(AbsoluteError(e.truth, e.estimate, row.alignment));
    for (const int percent : {30, 50, 100}) {
      j[std::to_string(percent) + "%"] =
          ToJson(MilestoneError(e.truth, e.estimate, row.alignment, percent / 100.0));
    }
  }
  out["rpe_1s"] = ToJson(e.relative);
  std::printf("%s\n", out.dump(2).c_str());
}

void PrintText(const Evaluation& e) {
  std::printf("%d pairs, %.0f %% of the truth's time reached\n", e.whole.n_pairs, 100 * e.whole.reached);
  if (!e.unscored.empty()) std::printf("%s\n", e.unscored.c_str());
  std::printf("\n");
  std::printf("ATE RMSE, cm / deg  %16s  %16s  %16s  %16s\n", "all", "30 %", "50 %", "100 %");
  for (const Row& row : kRows) {
    std::printf("  %-16s", row.name);
    PrintCell(AbsoluteError(e.truth, e.estimate, row.alignment));
    for (const double share : {0.3, 0.5, 1.0})
      PrintCell(MilestoneError(e.truth, e.estimate, row.alignment, share));
    std::printf("\n");
  }
  if (!AbsoluteError(e.truth, e.estimate, Alignment::kUmeyama).oriented) {
    std::printf(
        "no orientation error after an alignment by positions: they lie on a straight line, or on one spot, "
        "within %.0f cm, and leave the turn about it open\n",
        100 * TrajectoryError::kMinSpread);
  }
  std::printf("\nlargest error (no alignment): %.2f cm, %.2f deg\n", 100 * e.whole.position_max,
              kDegreesPerRadian * e.whole.orientation_max);
  if (e.relative.scored()) {
    std::printf("RPE over 1 s: %.2f cm, %.2f deg\n", 100 * e.relative.position_rmse,
                kDegreesPerRadian * e.relative.orientation_rmse);
  }
  if (e.consistency) std::printf("%s\n", ConsistencyText(*e.consistency).c_str());
}

void RunEval(const EvalOptions& o) {
  RequireOutput("--plot", o.plot);
  RequireNotAnInput("--plot", o.plot, {o.truth, o.estimate, o.covariance});
  const Evaluation evaluation = Evaluate(o);
  if (evaluation.consistency && !o.plot.empty()) {
    const Utime begin = evaluation.truth.front().t;
    pictures::PlotConsistency(o.plot, ConsistencyText(*evaluation.consistency), *evaluation.consistency,
                              {begin, begin, evaluation.truth.back().t, "truth"});
  }
  if (o.json) {
    PrintJson(o, evaluation);
  } else {
    PrintText(evaluation);
  }
}

}  // namespace

void AddEvalCommand(CLI::App* app) {
  auto o = std::make_shared<EvalOptions>();
  CLI::App* eval = app->add_subcommand("eval", "Score a trajectory against ground truth (TUM files)");
  eval->add_option("--truth", o->truth, "Ground truth, body in the map frame")->required();
  eval->add_option("--estimate", o->estimate, "Trajectory to score")->required();
  auto* covariance = eval->add_option("--covariance", o->covariance,
                                      "covariance.csv of the same run: scores the uncertainty too (NEES)");
  eval->add_option("--plot", o->plot, "With --covariance: PNG of the errors between their 2-sigma bounds")
      ->needs(covariance);
  eval->add_flag("--json", o->json, "Machine-readable output");
  eval->footer(
      "Example: evit eval --truth desk/truth.tum --estimate result/trajectory.tum --covariance "
      "result/covariance.csv");
  eval->callback([o] { RunEval(*o); });
}

}  // namespace evit::commands
