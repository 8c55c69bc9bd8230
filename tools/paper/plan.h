#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/paper/recording.h"
#include "tools/paper/results.h"

namespace evit::paper {

struct PaperOptions {
  std::string config;             // config/paper.textproto
  std::string vector;             // VECtor's files; empty: everything is simulated
  std::string out;                // folder of the results
  std::string programs;           // folder of evit and the services
  std::string shared_data;        // folder of recorded motions; empty: none
  std::vector<std::string> only;  // tables, sequences, methods; empty: all
  std::optional<int> seeds;       // in place of the configuration's
  bool quick = false;             // one seed, short clips
  int jobs = 2;                   // run in parallel
};

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
