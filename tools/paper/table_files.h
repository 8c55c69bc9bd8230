#pragma once

#include <string>
#include <vector>

#include "tools/paper/paper_results.h"
#include "tools/paper/text_table.h"

namespace evit::paper {

/// One row per sequence and method, plain numbers, nothing for "-"; for programs.
TextTable LongLayout(const paper::Paper& config, const PaperResults& results, PaperTable table,
                     Alignment alignment);

/// The same as JSON, with every seed's own figures.
std::string TableJson(const paper::Paper& config, const PaperResults& results, PaperTable table,
                      Alignment alignment);

/// Writes DIR/<table>.<alignment>.{md,csv,json} of every table that has rows. Returns the .md files' names.
/// Throws std::runtime_error naming the file.
std::vector<std::string> WriteTables(const std::string& folder, const paper::Paper& config,
                                     const PaperResults& results);

}  // namespace evit::paper
