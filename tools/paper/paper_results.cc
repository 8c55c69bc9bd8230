#include "tools/paper/paper_results.h"

namespace evit::paper {

namespace {

struct Names {
  const char *id, *number;
};
// In the order of PaperTable.
constexpr Names kNames[] = {{"normal", "I"}, {"fast", "II"}, {"motion_models", "III"}};

}  // namespace

const char* TableId(PaperTable table) { return kNames[static_cast<int>(table)].id; }
const char* TableNumber(PaperTable table) { return kNames[static_cast<int>(table)].number; }

std::vector<TableRow> RowsOf(const paper::Paper& config, const PaperResults& results, PaperTable table) {
  const bool ablation = table == PaperTable::kMotionModels;
  std::vector<TableRow> rows;
  for (const paper::Sequence& sequence : config.sequence()) {
    if (!ablation && sequence.fast() != (table == PaperTable::kFast)) continue;
    for (const paper::Method& method : ablation ? config.motion_model() : config.method()) {
      const auto* runs = results.Find(sequence.name(), method.id());
      if (runs != nullptr) rows.push_back({&sequence, &method, runs});
    }
  }
  return rows;
}

}  // namespace evit::paper
