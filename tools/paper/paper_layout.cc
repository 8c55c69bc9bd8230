#include "tools/paper/paper_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/paper/summary.h"

namespace evit::paper {
namespace {

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

// Position or orientation of one milestone.
struct Cell {
  const Summary::Milestone* milestone;
  bool position;
  const std::optional<Spread>& spread() const {
    return position ? milestone->position_cm : milestone->orientation_deg;
  }
};

std::string Text(const Cell& cell, int seeds, bool best) {
  if (!cell.spread()) {
    const int reached = cell.milestone->reached;
    return reached == 0 ? "-" : "- (" + std::to_string(reached) + "/" + std::to_string(seeds) + ")";
  }
  std::string text = Number(cell.spread()->median);
  if (best) text = "**" + text + "**";
  if (seeds > 1) text += " (" + Number(cell.spread()->worst) + ")";
  return text;
}

// Texts of cells that compete: of what prints the same as the smallest, each is bold. Alone nothing is best.
std::vector<std::string> TextsOf(const std::vector<Cell>& cells, const std::vector<int>& seeds) {
  double best = INFINITY;
  for (const Cell& cell : cells) {
    if (cell.spread()) best = std::min(best, cell.spread()->median);
  }
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const bool is_best =
        cells.size() > 1 && cells[k].spread() && Number(cells[k].spread()->median) == Number(best);
    texts.push_back(Text(cells[k], seeds[k], is_best));
  }
  return texts;
}

// Rows of one sequence.
struct Group {
  std::string name;
  std::vector<const paper::Method*> methods;
  std::vector<Summary> summaries;
  std::vector<int> seeds;
};

std::vector<Group> GroupsOf(const paper::Paper& config, const PaperResults& results, PaperTable table) {
  std::vector<Group> groups;
  for (const TableRow& row : RowsOf(config, results, table)) {
    if (groups.empty() || groups.back().name != row.sequence->name())
      groups.push_back({row.sequence->name(), {}, {}, {}});
    groups.back().methods.push_back(row.method);
    groups.back().summaries.push_back(Summarize(*row.runs));
    groups.back().seeds.push_back(groups.back().summaries.back().seeds);
  }
  return groups;
}

void AppendMethods(const Group& group, std::size_t alignment, TextTable* out) {
  const std::size_t first = out->rows.size();
  for (std::size_t k = 0; k < group.methods.size(); ++k)
    out->rows.push_back({group.name, group.methods[k]->name(), group.methods[k]->frequency()});
  for (std::size_t m = 0; m < kMilestones.size(); ++m) {
    for (const bool position : {true, false}) {
      std::vector<Cell> cells;
      for (const Summary& s : group.summaries) cells.push_back({&s.ate[alignment][m], position});
      const auto texts = TextsOf(cells, group.seeds);
      for (std::size_t k = 0; k < texts.size(); ++k) out->rows[first + k].push_back(texts[k]);
    }
  }
  for (std::size_t k = 0; k < group.summaries.size(); ++k) {
    out->rows[first + k].push_back(Number(group.summaries[k].keyframe_rate_hz.median));
    out->rows[first + k].push_back(Number(group.summaries[k].cpu_s_per_s.median));
  }
}

void AppendModels(const Group& group, const paper::Paper& config, std::size_t alignment, TextTable* out) {
  std::vector<std::string> row{group.name};
  std::vector<std::vector<std::string>> texts;
  for (const bool position : {true, false}) {
    std::vector<Cell> cells;
    for (const Summary& s : group.summaries) cells.push_back({&s.ate[alignment].back(), position});
    texts.push_back(TextsOf(cells, group.seeds));
  }
  for (const paper::Method& model : config.motion_model()) {
    const auto at = std::find_if(group.methods.begin(), group.methods.end(),
                                 [&](const paper::Method* m) { return m->id() == model.id(); });
    const std::size_t k = at - group.methods.begin();
    const bool there = at != group.methods.end();
    row.push_back(there ? texts[0][k] : "");
    row.push_back(there ? texts[1][k] : "");
    row.push_back(there ? Number(group.summaries[k].keyframe_rate_hz.median) : "");
    row.push_back(there ? Number(group.summaries[k].cpu_s_per_s.median) : "");
  }
  out->rows.push_back(row);
}

}  // namespace

TextTable PaperLayout(const paper::Paper& config, const PaperResults& results, PaperTable table,
                      Alignment alignment) {
  TextTable out;
  if (table == PaperTable::kMotionModels) {
    out.header = {"Sequence"};
    for (const paper::Method& model : config.motion_model()) {
      for (const char* what : {"Pos.", "Orient.", "Hz", "CPU s/s"})
        out.header.push_back(model.name() + " " + what);
    }
  } else {
    out.header = {"Sequence",     "Method",     "Frequency",     "30 % Pos.",    "30 % Orient.", "50 % Pos.",
                  "50 % Orient.", "100 % Pos.", "100 % Orient.", "Keyframes Hz", "CPU s/s"};
  }
  for (const Group& group : GroupsOf(config, results, table)) {
    if (table == PaperTable::kMotionModels) {
      AppendModels(group, config, AlignmentIndex(alignment), &out);
    } else {
      AppendMethods(group, AlignmentIndex(alignment), &out);
    }
  }
  return out;
}

std::string TableTitle(PaperTable table, Alignment alignment) {
  const std::string of = table == PaperTable::kNormal ? "normal sequences"
                         : table == PaperTable::kFast ? "fast sequences"
                                                      : "different motion models, whole sequences";
  return std::string("Table ") + TableNumber(table) + ". Absolute trajectory error (RMSE) on " + of + ", " +
         AlignmentText(alignment) + ". Position: cm, orientation: degrees";
}

std::vector<std::string> Losses(const paper::Paper& config, const PaperResults& results) {
  std::vector<std::string> lines;
  for (const paper::Sequence& sequence : config.sequence()) {
    for (const paper::Method& method : AllMethods(config)) {
      const auto* runs = results.Find(sequence.name(), method.id());
      for (std::size_t k = 0; runs != nullptr && k < runs->size(); ++k) {
        const RunScore& run = (*runs)[k];
        if (run.lost.empty()) continue;
        lines.push_back(sequence.name() + " " + std::to_string(k + 1) + ", " + method.id() + ": " + run.lost);
      }
    }
  }
  return lines;
}

}  // namespace evit::paper
