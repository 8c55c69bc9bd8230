#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/evaluation/trajectory_error.h"
#include "tools/evit/commands.h"

namespace evit {
namespace {

constexpr double kDegrees = 57.295779513082323;

struct Row {
  const char* name;
  Alignment alignment;
};
constexpr Row kRows[] = {
    {"none", Alignment::kNone}, {"first pair", Alignment::kFirstPair}, {"Umeyama", Alignment::kUmeyama}};

nlohmann::json ToJson(const TrajectoryError& e) {
  if (e.n_pairs == 0) return nullptr;
  return {{"pairs", e.n_pairs},
          {"position_rmse_cm", 100 * e.position_rmse},
          {"orientation_rmse_deg", kDegrees * e.orientation_rmse},
          {"position_max_cm", 100 * e.position_max},
          {"orientation_max_deg", kDegrees * e.orientation_max}};
}

void PrintCell(const TrajectoryError& e) {
  if (e.n_pairs == 0) {
    std::printf("  %16s", "-");
  } else {
    std::printf("  %7.2f / %6.2f", 100 * e.position_rmse, kDegrees * e.orientation_rmse);
  }
}

void Evaluate(const std::string& truth_file, const std::string& estimate_file, bool json) {
  const Trajectory truth = ReadTum(truth_file), estimate = ReadTum(estimate_file);
  const TrajectoryError whole = AbsoluteError(truth, estimate, Alignment::kNone);
  if (whole.n_pairs == 0) {
    throw std::runtime_error(estimate_file + " and " + truth_file +
                             " share no time: are they of the same sequence?");
  }
  const TrajectoryError relative = RelativeError(truth, estimate, kMicrosPerSecond);
  if (json) {
    nlohmann::json out{{"truth", truth_file}, {"estimate", estimate_file}, {"coverage", whole.coverage}};
    for (const Row& row : kRows) {
      nlohmann::json& j = out["ate"][row.name];
      j["all"] = ToJson(AbsoluteError(truth, estimate, row.alignment));
      for (const int percent : {30, 50, 100}) {
        j[std::to_string(percent) + "%"] =
            ToJson(MilestoneError(truth, estimate, row.alignment, percent / 100.0));
      }
    }
    out["rpe_1s"] = ToJson(relative);
    std::printf("%s\n", out.dump(2).c_str());
    return;
  }
  std::printf("%d poses, %.0f %% of the truth's time reached\n\n", whole.n_pairs, 100 * whole.coverage);
  std::printf("ATE RMSE, cm / deg  %16s  %16s  %16s  %16s\n", "all", "30 %", "50 %", "100 %");
  for (const Row& row : kRows) {
    std::printf("  %-16s", row.name);
    PrintCell(AbsoluteError(truth, estimate, row.alignment));
    for (const double share : {0.3, 0.5, 1.0})
      PrintCell(MilestoneError(truth, estimate, row.alignment, share));
    std::printf("\n");
  }
  std::printf("\nlargest error (no alignment): %.2f cm, %.2f deg\n", 100 * whole.position_max,
              kDegrees * whole.orientation_max);
  if (relative.n_pairs > 0) {
    std::printf("RPE over 1 s: %.2f cm, %.2f deg\n", 100 * relative.position_rmse,
                kDegrees * relative.orientation_rmse);
  }
}

}  // namespace

void AddEvalCommand(CLI::App* app) {
  struct Options {
    std::string truth, estimate;
    bool json = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* eval = app->add_subcommand("eval", "Score a trajectory against ground truth (TUM files)");
  eval->add_option("--truth", o->truth, "Ground truth, body in the map frame")->required();
  eval->add_option("--estimate", o->estimate, "Trajectory to score")->required();
  eval->add_flag("--json", o->json, "Machine-readable output");
  eval->callback([o] { Evaluate(o->truth, o->estimate, o->json); });
}

}  // namespace evit
