#include "tools/paper/results.h"

namespace evit::paper {

const char* TableId(PaperTable table) {
  switch (table) {
    case PaperTable::kNormal:
      return "normal";
    case PaperTable::kFast:
      return "fast";
    default:
      return "motion_models";
  }
}

const char* TableNumber(PaperTable table) {
  switch (table) {
    case PaperTable::kNormal:
      return "I";
    case PaperTable::kFast:
      return "II";
    default:
      return "III";
  }
}

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
