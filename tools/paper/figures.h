#pragma once

#include <string>
#include <vector>

#include "tools/paper/paper_plan.h"

namespace evit::paper {

struct Figure {
  std::string file;     // in the figures' folder; empty: could not be drawn
  std::string caption;  // or why not
};

/// Draws the paper's figures from the runs that are done, into `folder`: trajectories.png, motion_models.png,
/// window.png. Old ones that cannot be drawn today are removed. Throws std::runtime_error where the folder
/// cannot be written.
std::vector<Figure> DrawFigures(const std::string& folder, const PaperPlan& plan);

}  // namespace evit::paper
