#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/paper/paper_options.h"
#include "tools/paper/paper_results.h"
#include "tools/paper/recording.h"

namespace evit::paper {

/// `evit run` of one method on one recording.
struct PlannedRun {
  std::size_t recording = 0;  // index
  paper::Method method;
  bool selected = true;  // by options.only
  bool photometric = false;
  PaperJob job;
};

/// All there is to do, whether or not it is done already.
struct PaperPlan {
  paper::Paper config;
  std::vector<Recording> recordings;  // grouped by sequence, by seed
  std::vector<PlannedRun> runs;
  std::vector<std::string> left_out;     // what cannot be run, and why
  std::optional<PlannedRun> figure_run;  // a few seconds of the figures' sequence, with its keyframes
};

/// Throws std::runtime_error (ConfigError): configuration, missing files, a word of --only that means
/// nothing.
PaperPlan MakePlan(const PaperOptions& options);

/// The selected jobs of the plan, each after those it needs.
std::vector<PaperJob> JobsOf(const PaperPlan& plan);

/// Scores of all runs that are done, selected or not; a sequence and method count once all their seeds are
/// done.
PaperResults CollectResults(const PaperPlan& plan);

/// Folder names inside a run's: what its keyframes are recorded in.
inline constexpr char kKeyframeLog[] = "keyframes.lcmlog";

}  // namespace evit::paper
