#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace evit::bench {

/// Everything measured in one go.
struct Results {
  nlohmann::json context;  // of Google Benchmark: host, CPUs, date
  std::string commit;
  std::vector<nlohmann::json> rows;                          // of Google Benchmark
  std::vector<std::pair<std::string, nlohmann::json>> runs;  // name, report of `evit run`

  std::string ToJson() const;
};

/// Throws std::runtime_error naming a file that cannot be read or is not such JSON. `runs`: NAME=FILE.
Results LoadResults(const std::vector<std::string>& files, const std::vector<std::string>& runs,
                    const std::string& commit);

/// Seconds of CPU of one iteration.
double Seconds(const nlohmann::json& row);

/// Markdown: each NAME/ours beside its NAME/reference, ratio, target and bound; then the runs.
std::string Tables(const Results& results);

/// Throws std::runtime_error where the file cannot be written.
void WriteText(const std::string& path, const std::string& text);

}  // namespace evit::bench
