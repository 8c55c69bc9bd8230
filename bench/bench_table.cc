// Makes the tables and curves of docs/results/performance.md from the JSON files of the benchmarks and of
// `evit run`.
#include <iostream>

#include "bench/curves.h"
#include "bench/stages.h"
#include "bench/table.h"
#include "common/service/runner.h"

namespace {

int Main(int argc, char** argv) {
  evit::CommandLine line{"Tables and curves from benchmark results."};
  std::vector<std::string> results, runs;
  std::string json, markdown, curves, stages, commit;
  line.Add("results", &results, "JSON files of Google Benchmark").ExistingFiles();
  line.Add("--run", &runs, "NAME=report.json of `evit run`");
  line.Add("--commit", &commit, "Commit the results belong to");
  line.Add("--json", &json, "File to write all results to");
  line.Add("--markdown", &markdown, "File to write the tables to");
  line.Add("--curves", &curves, "Folder to write the scaling curves to (CSV and PNG)");
  line.Add("--stages", &stages, "PNG to draw where a keyframe's time goes, of the first run");
  if (const auto code = line.Parse(argc, argv)) return *code;
  const evit::bench::Results all = evit::bench::LoadResults(results, runs, commit);
  const std::string tables = evit::bench::Tables(all);
  std::cout << tables;
  if (!markdown.empty()) evit::bench::WriteText(markdown, tables);
  if (!json.empty()) evit::bench::WriteText(json, all.ToJson());
  if (!stages.empty() && !all.runs.empty()) evit::bench::DrawStages(all.runs.front().second, stages);
  if (!curves.empty()) evit::bench::WriteCurves(all, curves);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("bench_table", Main, argc, argv); }
