#include "tools/paper/index.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "procman/command_line.h"
#include "tools/paper/paper_layout.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

// The value of the first line "name ... : value".
std::string FieldOf(const std::string& file, const std::string& name) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind(name, 0) == 0 && colon != std::string::npos)
      return line.substr(std::min(line.size(), line.find_first_not_of(" \t", colon + 1)));
  }
  return "unknown";
}

void AppendTables(const PaperPlan& plan, const PaperResults& results, std::ostringstream* out) {
  for (const Alignment alignment : kAlignments) {
    *out << "## Tables, " << AlignmentText(alignment) << "\n\n";
    for (const PaperTable table : kPaperTables) {
      const TextTable text = PaperLayout(plan.config, results, table, alignment);
      if (text.rows.empty()) continue;
      const std::string file = std::string("tables/") + TableId(table) + "." + AlignmentId(alignment);
      *out << TableTitle(table, alignment) << " ([CSV](" << file << ".csv), [JSON](" << file << ".json)).\n\n"
           << text.Markdown() << "\n";
    }
  }
}

void AppendConditions(const PaperPlan& plan, const PaperResults& results, std::ostringstream* out) {
  *out << "## What the sequences are\n\n| sequence | source |\n|---|---|\n";
  for (const auto& sequence : plan.config.sequence()) {
    const auto source = results.sources.find(sequence.name());
    if (source != results.sources.end()) *out << "| " << sequence.name() << " | " << source->second << " |\n";
  }
  for (const std::string& line : plan.left_out) *out << "\nLeft out: " << line << ".\n";
  *out << "\n## Lost\n\n";
  const auto losses = Losses(plan.config, results);
  if (losses.empty()) *out << "Nothing.\n";
  for (const std::string& line : losses) *out << "- " << line << "\n";
}

}  // namespace

std::string DescribeCommit(const std::string& source_tree) {
  const std::string command =
      procman::JoinCommandLine({"git", "-C", source_tree, "describe", "--always", "--dirty", "--tags"}) +
      " 2>/dev/null";
  std::string text;
  if (FILE* pipe = popen(command.c_str(), "r")) {
    char line[200];
    if (std::fgets(line, sizeof line, pipe) != nullptr) text = line;
    pclose(pipe);
  }
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text.empty() ? "unknown" : text;
}

std::string DescribeMachine() {
  utsname system{};
  uname(&system);
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  char memory[32];
  std::snprintf(memory, sizeof memory, "%.0f GB",
                1e-9 * static_cast<double>(pages) * static_cast<double>(size));
  return FieldOf("/proc/cpuinfo", "model name") + ", " + std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) +
         " processors, " + memory + ", " + system.sysname + " " + system.release;
}

std::string IndexText(const PaperPlan& plan, const PaperResults& results, const std::vector<Figure>& figures,
                      const IndexFacts& facts) {
  std::ostringstream out;
  out << "# The paper's tables and figures\n\n"
         "RMSE of the absolute trajectory error, all online poses, at 30, 50 and 100 % of a sequence. A "
         "method that is "
         "lost has ended: \"-\" where it did not reach a milestone. With several rooms: the median, and the "
         "worst in "
         "brackets; a milestone counts where it was reached in all of them (k/n: in k of n). Best of a "
         "sequence in "
         "bold. Keyframes Hz: poses per second while it tracked. CPU s/s: CPU seconds of all services per "
         "second of the "
         "sequence, over the whole of it.\n\n";
  if (facts.outcome.interrupted) out << "**Interrupted: what follows is a part.**\n\n";
  AppendTables(plan, results, &out);
  AppendConditions(plan, results, &out);
  out << "\n## Figures\n";
  for (const Figure& figure : figures) {
    out << "\n" << figure.caption << ".\n";
    if (!figure.file.empty()) out << "\n![](figures/" << figure.file << ")\n";
  }
  if (!facts.outcome.failures.empty()) out << "\n## Failed\n\n";
  for (const auto& failure : facts.outcome.failures)
    out << "- " << failure.id << ": " << failure.words << "\n";
  char wall[64];
  std::snprintf(wall, sizeof wall, "%.0f s", facts.wall_s);
  out << "\n## How it was made\n\n"
      << "- command: `" << facts.command << "`\n- commit: " << facts.commit
      << "\n- machine: " << facts.machine << "\n- time: " << wall << "; " << facts.outcome.done
      << " simulations, imports and runs done, " << facts.outcome.kept
      << " kept from before\n- configuration: each run's folder below `work/runs` has its "
      << "`tracker.textproto` and `report.json`; the methods:\n\n| id | name | frequency | settings "
         "|\n|---|---|---|---|\n";
  for (const paper::Method& m : AllMethods(plan.config)) {
    out << "| " << m.id() << " | " << m.name() << " | " << m.frequency() << " | "
        << m.config().substr(m.config().rfind('/') + 1);
    if (m.has_fixed_rate_hz()) out << ", keyframes.fixed_rate_hz " << m.fixed_rate_hz();
    if (m.has_motion_model())
      out << ", evit.motion_model " << config::Evit::MotionModel_Name(m.motion_model());
    out << " |\n";
  }
  return out.str();
}

}  // namespace evit::paper
