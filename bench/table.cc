#include "bench/table.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "common/text/format_text.h"

namespace evit::bench {
namespace {

using nlohmann::json;

json Load(const std::string& path) {
  std::ifstream file(path);
  json parsed = json::parse(file, nullptr, false);
  if (parsed.is_discarded()) throw std::runtime_error(path + ": cannot be read as JSON");
  return parsed;
}

double Number(const json& row, const char* key) { return row.contains(key) ? row[key].get<double>() : 0; }

// "NAME/ours/6/1000" -> "NAME"; empty where the row is not one of ours.
std::string NameOfOurs(const std::string& name) {
  const auto at = name.find("/ours");
  return at == std::string::npos ? "" : name.substr(0, at);
}

const json* Find(const Results& results, const std::string& prefix) {
  for (const json& row : results.rows) {
    if (row["name"].get<std::string>().rfind(prefix, 0) == 0) return &row;
  }
  return nullptr;
}

std::string Value(const json& row) {
  if (row.contains("items/s")) return FormatText("%.3g M/s", Number(row, "items/s") * 1e-6);
  return FormatText("%.3g ms", 1e3 * Seconds(row));
}

// How many times better ours is.
double Ratio(const json& ours, const json& reference) {
  return ours.contains("items/s") ? Number(ours, "items/s") / Number(reference, "items/s")
                                  : Seconds(reference) / Seconds(ours);
}

std::string Target(const json& row) {
  if (Number(row, "target_items/s") > 0) {
    const bool met = Number(row, "items/s") >= Number(row, "target_items/s");
    return FormatText("%.3g M/s %s", Number(row, "target_items/s") * 1e-6, met ? "✓" : "✗");
  }
  if (Number(row, "target_s") > 0) {
    return FormatText("%.3g ms %s", 1e3 * Number(row, "target_s"),
                      Seconds(row) <= Number(row, "target_s") ? "✓" : "✗");
  }
  return "";
}

std::string Bound(const json& row, double bandwidth) {
  double bytes_per_s = 0;
  if (Number(row, "bytes_per_item") > 0) bytes_per_s = Number(row, "bytes_per_item") * Number(row, "items/s");
  if (Number(row, "bytes") > 0) bytes_per_s = Number(row, "bytes") / Seconds(row);
  if (bytes_per_s <= 0 || bandwidth <= 0) return "arithmetic";
  return FormatText("moves %.1f GB/s, %.0f %% of main memory's", bytes_per_s * 1e-9,
                    100 * bytes_per_s / bandwidth);
}

std::string MicroTable(const Results& results) {
  const json* memory = Find(results, "Memory/main");
  const double bandwidth = memory == nullptr ? 0 : Number(*memory, "bytes/s");
  std::string out =
      "| one thread | ours | plain reference | ratio | target | bound |\n|---|---|---|---|---|---|\n";
  for (const json& row : results.rows) {
    const std::string name = NameOfOurs(row["name"]);
    if (name.empty()) continue;
    const json* reference = Find(results, name + "/reference");
    out.append("| ").append(name).append(" | ").append(Value(row)).append(" | ");
    out.append(reference == nullptr ? "" : Value(*reference)).append(" | ");
    out.append(reference == nullptr ? "" : FormatText("%.1f", Ratio(row, *reference))).append(" | ");
    out.append(Target(row)).append(" | ").append(Bound(row, bandwidth)).append(" |\n");
  }
  if (memory != nullptr)
    out += FormatText("\nMain memory: %.1f GB/s read and written, one thread.\n", bandwidth * 1e-9);
  return out;
}

double Peak(const json& report) {
  double sum = 0;
  for (const json& service : report["services"]) sum += Number(service, "peak_memory_mb");
  return sum;
}

// CPU over that of the reference's window solve: comparable from machine to machine, absolute figures are
// not. Of a keyframe, and of 20 ms of the sequence, which do not depend on how many keyframes are made.
std::string OfReferenceSolve(const Results& results, const json& report) {
  const json* solve = Find(results, "Window solve/reference");
  const double cpu_ms = Number(report, "cpu_ms_per_keyframe");
  return solve == nullptr
             ? "-"
             : FormatText("%.4f / %.4f", 1e-3 * cpu_ms / Seconds(*solve),
                          0.02e-3 * cpu_ms * Number(report, "keyframe_rate_hz") / Seconds(*solve));
}

// What this machine needs for what every machine can measure: divide by it to compare.
std::string Machine(const Results& results) {
  std::string out = "This machine:";
  const json *solve = Find(results, "Window solve/reference"),
             *surface = Find(results, "Render one surface/reference"), *memory = Find(results, "Memory/main");
  if (solve != nullptr) out += FormatText(" plain window solve %.0f ms,", 1e3 * Seconds(*solve));
  if (surface != nullptr) out += FormatText(" plain surface %.1f ms,", 1e3 * Seconds(*surface));
  if (memory != nullptr) out += FormatText(" main memory %.1f GB/s,", 1e-9 * Number(*memory, "bytes/s"));
  const json& load = results.context["load_avg"];
  return out + (load.empty() ? "" : FormatText(" load %.1f meanwhile,", load[0].get<double>())) +
         " one thread each.\n\n";
}

std::string RunTables(const Results& results) {
  std::string lossless =
      "\n| whole pipeline over UDP, lossless | Mev/s | keyframes/s | real-time factor | CPU ms/keyframe | "
      "of a plain window solve: per keyframe / per 20 ms | ATE cm / deg | memory of the four "
      "|\n|---|---|---|---|---|---|---|---|\n";
  std::string real_time =
      "\n| real time | Mev/s | pose after its last event p50 / p99 / max, ms | after its instant p50 / p99 | "
      "IMU-rate pose "
      "p50 / p99, ms | lost | ATE cm / deg | memory |\n|---|---|---|---|---|---|---|---|\n";
  bool any_lossless = false, any_real_time = false;
  for (const auto& [name, r] : results.runs) {
    std::string error = "-";
    if (!r["ate"].empty()) {
      const json& e = r["ate"][0]["all"];
      error = FormatText("%.2f / %.2f", Number(e, "position_rmse_cm"), Number(e, "orientation_rmse_deg"));
    }
    const double rate = 1e-6 * Number(r, "event_rate_per_s");
    if (r["lossless"].get<bool>()) {
      any_lossless = true;
      lossless.append("| ").append(name);
      lossless += FormatText(" | %.2f | %.0f | %.2f | %.1f | ", rate, Number(r, "keyframe_rate_hz"),
                             Number(r, "real_time_factor"), Number(r, "cpu_ms_per_keyframe"));
      lossless.append(OfReferenceSolve(results, r)).append(" | ");
      lossless.append(error).append(FormatText(" | %.0f MB |\n", Peak(r)));
      continue;
    }
    any_real_time = true;
    const json empty = json::object();
    const auto part = [&r = r, &empty](const char* key) -> const json& {
      return r.contains(key) ? r[key] : empty;
    };
    const json &events = part("pose_after_events"), &imu = part("imu_pose");
    double lost = 0;
    for (const json& service : r["services"]) {
      for (const auto& [counter, value] : service["counters"].items()) {
        const auto ends = [&key = counter](const std::string& end) {
          return key.size() > end.size() && key.compare(key.size() - end.size(), end.size(), end) == 0;
        };
        if (counter != "mode.lost" && (ends(".lost") || ends(".dropped"))) lost += value.get<double>();
      }
    }
    real_time.append("| ").append(name);
    real_time += FormatText(
        " | %.2f | %.1f / %.1f / %.1f | %.1f / %.1f | %.1f / %.1f | %.0f | ", rate, Number(events, "p50_ms"),
        Number(events, "p99_ms"), Number(events, "max_ms"), Number(part("pose_after_stamp"), "p50_ms"),
        Number(part("pose_after_stamp"), "p99_ms"), Number(imu, "p50_ms"), Number(imu, "p99_ms"), lost);
    real_time.append(error).append(FormatText(" | %.0f MB |\n", Peak(r)));
  }
  return (any_lossless ? lossless : "") + (any_real_time ? real_time : "");
}

}  // namespace

std::string Results::ToJson() const {
  json all;
  all["commit"] = commit;
  all["context"] = context;
  all["benchmarks"] = rows;
  for (const auto& [name, report] : runs) {
    json brief = report;
    brief.erase("config");
    brief.erase("mode_changes");
    all["runs"][name] = brief;
  }
  return all.dump(1) + "\n";
}

double Seconds(const json& row) {
  const std::string unit = row["time_unit"];
  const double scale = unit == "ns" ? 1e-9 : unit == "us" ? 1e-6 : unit == "ms" ? 1e-3 : 1;
  return scale * row["cpu_time"].get<double>();
}

Results LoadResults(const std::vector<std::string>& files, const std::vector<std::string>& runs,
                    const std::string& commit) {
  Results results;
  results.commit = commit;
  for (const std::string& file : files) {
    const json parsed = Load(file);
    if (!parsed.contains("benchmarks")) throw std::runtime_error(file + ": holds no benchmarks");
    results.context = parsed["context"];
    for (const json& row : parsed["benchmarks"]) results.rows.push_back(row);
  }
  for (const std::string& run : runs) {
    const auto at = run.find('=');
    if (at == std::string::npos) throw std::runtime_error("--run " + run + ": expected NAME=FILE");
    results.runs.emplace_back(run.substr(0, at), Load(run.substr(at + 1)));
  }
  return results;
}

std::string Tables(const Results& results) {
  std::string out;
  if (!results.context.is_null()) {
    out = FormatText("Commit %s, %s, %d CPUs at %d MHz, %s\n\n", results.commit.c_str(),
                     results.context["host_name"].get<std::string>().c_str(),
                     results.context["num_cpus"].get<int>(), results.context["mhz_per_cpu"].get<int>(),
                     results.context["date"].get<std::string>().c_str());
    out += Machine(results) + MicroTable(results);
  }
  return out + RunTables(results);
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace evit::bench
