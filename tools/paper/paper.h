#pragma once

#include <string>

#include "tools/paper/paper_plan.h"

namespace evit::paper {

/// Makes the paper's tables and figures in options.out: simulates or imports what is missing, runs every
/// method, and writes tables/, figures/ and index.md from everything that is there. `command` and
/// `source_tree` are for index.md. Returns 0; 1 where a job failed (the others are done); 130 where it was
/// interrupted. Throws std::runtime_error.
int MakePaper(const PaperOptions& options, const std::string& command, const std::string& source_tree);

}  // namespace evit::paper
