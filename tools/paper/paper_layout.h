#pragma once

#include <string>
#include <vector>

#include "tools/paper/paper_results.h"
#include "tools/paper/text_table.h"

namespace evit::paper {

/// In the paper's layout: sequence x method x frequency, position (cm) and orientation (degrees) at 30, 50
/// and 100 %; or, for motion models, sequence x model at 100 %. A cell is the median over the seeds, with the
/// worst in brackets where there are several, or "-" where the milestone was not reached in all of them, with
/// "k/n" where in some. The best of a sequence (in the motion models' table too) is bold, all of them where
/// several print the same. Besides, keyframes per second and CPU seconds per second of the sequence.
TextTable PaperLayout(const paper::Paper& config, const PaperResults& results, PaperTable table,
                      Alignment alignment);

/// "Table I. Absolute trajectory error on normal sequences, ...".
std::string TableTitle(PaperTable table, Alignment alignment);

/// What was lost and when, one line each; empty where nothing was.
std::vector<std::string> Losses(const paper::Paper& config, const PaperResults& results);

}  // namespace evit::paper
