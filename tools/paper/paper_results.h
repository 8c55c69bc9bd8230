#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/paper/paper_config.h"
#include "tools/paper/run_score.h"

namespace evit::paper {

/// Every run that there is a result of.
struct PaperResults {
  /// By sequence and method id, one for each seed.
  std::map<std::pair<std::string, std::string>, std::vector<RunScore>> runs;
  /// By sequence: what it was, e.g. "recorded" or "simulated, builtin:fast, 10 s".
  std::map<std::string, std::string> sources;

  /// Null where there is none.
  const std::vector<RunScore>* Find(const std::string& sequence, const std::string& method) const {
    const auto it = runs.find({sequence, method});
    return it == runs.end() || it->second.empty() ? nullptr : &it->second;
  }
};

/// The paper's tables: I normal sequences, II fast ones, III motion models.
enum class PaperTable { kNormal, kFast, kMotionModels };
inline constexpr PaperTable kPaperTables[] = {PaperTable::kNormal, PaperTable::kFast,
                                              PaperTable::kMotionModels};
/// For file names and --only ("normal"), and as in the paper ("I").
const char* TableId(PaperTable table);
const char* TableNumber(PaperTable table);

/// Sequences and methods of a table that there are results of, in the configuration's order.
struct TableRow {
  const paper::Sequence* sequence = nullptr;
  const paper::Method* method = nullptr;
  const std::vector<RunScore>* runs = nullptr;
};
/// Grouped by sequence. The pointers are into both arguments.
std::vector<TableRow> RowsOf(const paper::Paper& config, const PaperResults& results, PaperTable table);

}  // namespace evit::paper
