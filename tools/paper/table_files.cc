#include "tools/paper/table_files.h"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/paper/paper_layout.h"
#include "tools/paper/summary.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

using Json = nlohmann::ordered_json;

std::string Percent(std::size_t milestone) {
  return std::to_string(static_cast<int>(100 * kMilestones[milestone] + 0.5));
}

std::string Plain(const std::optional<Spread>& spread, bool worst) {
  if (!spread) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", worst ? spread->worst : spread->median);
  return text;
}

Json ToJson(const Spread& spread) { return {{"median", spread.median}, {"worst", spread.worst}}; }

Json ToJson(const Summary::Milestone& milestone) {
  Json json{{"reached", milestone.reached}};
  if (milestone.position_cm) {
    json["position_cm"] = ToJson(*milestone.position_cm);
    json["orientation_deg"] = ToJson(*milestone.orientation_deg);
  }
  return json;
}

Json ToJson(const RunScore& run, std::size_t alignment) {
  Json json{{"tracked", run.tracked},
            {"keyframe_rate_hz", run.keyframe_rate_hz},
            {"cpu_s_per_s", run.cpu_s_per_s},
            {"lost", run.lost}};
  for (std::size_t m = 0; m < kMilestones.size(); ++m) {
    const auto& ate = run.ate[alignment][m];
    json[Percent(m) + "%"] =
        ate ? Json{{"position_cm", ate->position_cm}, {"orientation_deg", ate->orientation_deg}}
            : Json(nullptr);
  }
  return json;
}

}  // namespace

TextTable LongLayout(const paper::Paper& config, const PaperResults& results, PaperTable table,
                     Alignment alignment) {
  TextTable out;
  out.header = {"sequence", "source", "id", "method", "frequency", "seeds"};
  for (std::size_t m = 0; m < kMilestones.size(); ++m) {
    const std::string at = "_" + Percent(m);
    for (const char* what : {"reached", "position_cm_median", "position_cm_worst", "orientation_deg_median",
                             "orientation_deg_worst"})
      out.header.push_back(what + at);
  }
  for (const char* what : {"keyframe_rate_hz_median", "cpu_s_per_s_median", "cpu_s_per_s_worst"})
    out.header.emplace_back(what);
  for (const TableRow& row : RowsOf(config, results, table)) {
    const Summary s = Summarize(*row.runs);
    const auto source = results.sources.find(row.sequence->name());
    std::vector<std::string> cells{
        row.sequence->name(),    source == results.sources.end() ? "" : source->second,
        row.method->id(),        row.method->name(),
        row.method->frequency(), std::to_string(s.seeds)};
    for (const Summary::Milestone& m : s.ate[AlignmentIndex(alignment)]) {
      cells.push_back(std::to_string(m.reached));
      for (const auto& spread : {m.position_cm, m.orientation_deg}) {
        cells.push_back(Plain(spread, false));
        cells.push_back(Plain(spread, true));
      }
    }
    cells.push_back(Plain(s.keyframe_rate_hz, false));
    cells.push_back(Plain(s.cpu_s_per_s, false));
    cells.push_back(Plain(s.cpu_s_per_s, true));
    out.rows.push_back(cells);
  }
  return out;
}

std::string TableJson(const paper::Paper& config, const PaperResults& results, PaperTable table,
                      Alignment alignment) {
  Json json{{"table", TableNumber(table)},
            {"title", TableTitle(table, alignment)},
            {"alignment", AlignmentId(alignment)},
            {"rows", Json::array()}};
  for (const TableRow& row : RowsOf(config, results, table)) {
    const Summary s = Summarize(*row.runs);
    const auto source = results.sources.find(row.sequence->name());
    Json out{{"sequence", row.sequence->name()},
             {"source", source == results.sources.end() ? "" : source->second},
             {"id", row.method->id()},
             {"method", row.method->name()},
             {"frequency", row.method->frequency()},
             {"seeds", s.seeds}};
    for (std::size_t m = 0; m < kMilestones.size(); ++m)
      out[Percent(m) + "%"] = ToJson(s.ate[AlignmentIndex(alignment)][m]);
    out["keyframe_rate_hz"] = ToJson(s.keyframe_rate_hz);
    out["cpu_s_per_s"] = ToJson(s.cpu_s_per_s);
    for (const RunScore& run : *row.runs) out["runs"].push_back(ToJson(run, AlignmentIndex(alignment)));
    json["rows"].push_back(out);
  }
  return json.dump(2) + "\n";
}

std::vector<std::string> WriteTables(const std::string& folder, const paper::Paper& config,
                                     const PaperResults& results) {
  std::vector<std::string> written;
  MakeFolder(folder);
  for (const PaperTable table : kPaperTables) {
    for (const Alignment alignment : kAlignments) {
      const std::string name = std::string(TableId(table)) + "." + AlignmentId(alignment);
      const std::string base = folder + "/" + name;
      if (RowsOf(config, results, table).empty()) {  // nothing old may pass for a result of today
        for (const char* end : {".md", ".csv", ".json"}) std::filesystem::remove(base + end);
        continue;
      }
      WriteText(base + ".md", TableTitle(table, alignment) + "\n\n" +
                                  PaperLayout(config, results, table, alignment).Markdown());
      WriteText(base + ".csv", LongLayout(config, results, table, alignment).Csv());
      WriteText(base + ".json", TableJson(config, results, table, alignment));
      written.push_back(name + ".md");
    }
  }
  return written;
}

}  // namespace evit::paper
