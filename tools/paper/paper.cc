#include "tools/paper/paper.h"

#include <chrono>
#include <cstdio>

#include "common/service/stop_signals.h"
#include "tools/paper/figures.h"
#include "tools/paper/index.h"
#include "tools/paper/paper_layout.h"
#include "tools/paper/run_jobs.h"
#include "tools/paper/table_files.h"
#include "tools/paper/text_files.h"
#include "tools/terminal/progress_bar.h"

namespace evit::paper {

int MakePaper(const PaperOptions& options, const std::string& command, const std::string& source_tree) {
  const auto begin = std::chrono::steady_clock::now();
  const PaperPlan plan = MakePlan(options);
  MakeFolder(options.out + "/work");
  const StopSignals signals;

  IndexFacts facts;
  {
    terminal::ProgressBar bar("paper");
    facts.outcome = RunJobs(
        JobsOf(plan), options.jobs, options.programs,
        [&](double share, const std::string& note) { bar.Show(share, note); },
        [&] { return signals.received(); });
  }
  if (facts.outcome.interrupted) {
    std::fprintf(stderr,
                 "evit paper: interrupted: %zu of %zu jobs are done and kept; the same command continues\n",
                 facts.outcome.done + facts.outcome.kept, JobsOf(plan).size());
  }
  for (const auto& failure : facts.outcome.failures)
    std::fprintf(stderr, "evit paper: %s failed: %s\n", failure.id.c_str(), failure.words.c_str());

  const PaperResults results = CollectResults(plan);
  WriteTables(options.out + "/tables", plan.config, results);
  const std::vector<Figure> figures = DrawFigures(options.out + "/figures", plan);
  facts.command = command;
  facts.commit = DescribeCommit(source_tree);
  facts.machine = DescribeMachine();
  facts.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  WriteText(options.out + "/index.md", IndexText(plan, results, figures, facts));
  for (const PaperTable table : kPaperTables) {
    const TextTable text = PaperLayout(plan.config, results, table, kAlignments.front());
    if (!text.rows.empty())
      std::printf("%s\n\n%s\n", TableTitle(table, kAlignments.front()).c_str(), text.Markdown().c_str());
  }
  std::printf("%zu jobs done, %zu kept, %zu failed; everything is in %s/index.md\n", facts.outcome.done,
              facts.outcome.kept, facts.outcome.failures.size(), options.out.c_str());
  if (facts.outcome.interrupted) return 130;
  return facts.outcome.failures.empty() ? 0 : 1;
}

}  // namespace evit::paper
