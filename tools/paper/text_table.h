#pragma once

#include <string>
#include <vector>

#include "tools/paper/paper_results.h"

namespace evit::paper {

/// Rows of text, as they are printed.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  std::string Markdown() const;
  std::string Csv() const;  // RFC 4180
};

/// In the paper's layout: sequence x method x frequency, position (cm) and orientation (degrees) at 30, 50
/// and 100 %; or, for motion models, sequence x model at 100 %. A cell is the median over the seeds, with the
/// worst in brackets where there are several, or "-" where the milestone was not reached in all of them, with
/// "k/n" where in some. The best of a sequence (in the motion models' table too) is bold, all of them where
/// several print the same. Besides, keyframes per second and CPU seconds per second of the sequence.
TextTable PaperLayout(const paper::Paper& config, const PaperResults& results, PaperTable table,
                      Alignment alignment);

/// One row per sequence and method, plain numbers, nothing for "-"; for programs.
TextTable LongLayout(const paper::Paper& config, const PaperResults& results, PaperTable table,
                     Alignment alignment);

/// The same with every seed's own figures.
std::string TableJson(const paper::Paper& config, const PaperResults& results, PaperTable table,
                      Alignment alignment);

/// "Table I. Absolute trajectory error on normal sequences, ...".
std::string TableTitle(PaperTable table, Alignment alignment);

/// What was lost and when, one line each; empty where nothing was.
std::vector<std::string> Losses(const paper::Paper& config, const PaperResults& results);

/// Writes DIR/<table>.<alignment>.{md,csv,json} of every table that has rows. Returns the .md files' names.
/// Throws std::runtime_error naming the file.
std::vector<std::string> WriteTables(const std::string& folder, const paper::Paper& config,
                                     const PaperResults& results);

}  // namespace evit::paper
