#pragma once

#include <string>
#include <vector>

#include "tools/paper/figures.h"
#include "tools/paper/paper_plan.h"
#include "tools/paper/run_jobs.h"

namespace evit::paper {

/// What index.md says besides tables and figures.
struct IndexFacts {
  std::string command;  // as it can be typed again
  std::string commit;   // of the source tree; "unknown" where there is none
  std::string machine;  // processor, number of cores, memory, kernel
  double wall_s = 0;
  JobsOutcome outcome;
};

/// `git describe` of a source tree; "unknown" where git does not know it.
std::string DescribeCommit(const std::string& source_tree);
std::string DescribeMachine();

/// The text of index.md: tables, figures, losses, failures, then how it was made.
std::string IndexText(const PaperPlan& plan, const PaperResults& results, const std::vector<Figure>& figures,
                      const IndexFacts& facts);

}  // namespace evit::paper
