#include "tools/paper/selection.h"

#include <algorithm>
#include <stdexcept>

namespace evit::paper {
namespace {

template <typename List, typename Item>
bool Has(const List& list, const Item& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

bool InTable(const paper::Paper& config, PaperTable table, const paper::Sequence& sequence,
             const paper::Method& method) {
  const bool ablation = table == PaperTable::kMotionModels;
  if (!ablation && sequence.fast() != (table == PaperTable::kFast)) return false;
  const auto& methods = ablation ? config.motion_model() : config.method();
  return std::any_of(methods.begin(), methods.end(),
                     [&](const paper::Method& m) { return m.id() == method.id(); });
}

}  // namespace

Selection::Selection(const paper::Paper& config, const std::vector<std::string>& words) : config_(config) {
  std::string known;
  for (const PaperTable table : kPaperTables)
    known += std::string(known.empty() ? "" : ", ") + TableNumber(table) + " or " + TableId(table);
  for (const auto& s : config.sequence()) known += ", " + s.name();
  for (const auto& m : AllMethods(config)) known += ", " + m.id();
  for (const std::string& word : words) {
    bool found = false;
    for (const PaperTable table : kPaperTables) {
      if (word != TableNumber(table) && word != TableId(table)) continue;
      tables_.push_back(table);
      found = true;
    }
    for (const auto& s : config.sequence()) {
      if (word != s.name()) continue;
      sequences_.push_back(word);
      found = true;
    }
    for (const auto& m : AllMethods(config)) {
      if (word != m.id() && word != m.name()) continue;
      methods_.push_back(m.id());
      found = true;
    }
    if (!found)
      throw std::runtime_error("--only " + word + ": is not a table, sequence or method; known: " + known);
  }
}

bool Selection::Wants(const paper::Sequence& sequence, const paper::Method& method) const {
  if (!sequences_.empty() && !Has(sequences_, sequence.name())) return false;
  if (!methods_.empty() && !Has(methods_, method.id())) return false;
  return tables_.empty() || std::any_of(tables_.begin(), tables_.end(), [&](PaperTable table) {
           return InTable(config_, table, sequence, method);
         });
}

}  // namespace evit::paper
