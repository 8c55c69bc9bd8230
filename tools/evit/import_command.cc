#include <cstdio>

#include "tools/evit/commands.h"
#include "tools/evit/import_options.h"
#include "tools/evit/options.h"
#include "tools/terminal/progress_bar.h"

namespace evit::commands {
namespace {

void PrintDropped(const formats::DropCounts& dropped, const char* what) {
  const std::string text = formats::DropText(dropped, what);
  if (!text.empty()) std::printf("%s\n", text.c_str());
}

}  // namespace

void ImportOptions::AddTo(CLI::App* source, bool require_out) {
  source->add_option("--out", out, "Log to write; the ground truth of the body is written to FILE.truth.tum")
      ->required(require_out);
  source->add_option(
      "--T-map-world", transform,
      "16 numbers, row-major 4x4, from the frame of the ground truth to that of the map (default: identity)");
  source->add_option("--seconds", seconds, "A:B in s after the first event, take only this part");
}

void ImportOptions::Apply(formats::ImportTarget* target) const {
  target->out = out;
  if (!transform.empty()) target->T_map_world = ParseTransform("--T-map-world", transform);
  if (!seconds.empty()) target->seconds = ParseSeconds(seconds);
}

void RunImport(const std::string& label, const formats::ImportTarget& target, const std::string& no_truth,
               const std::function<formats::ImportSummary(const std::function<void(double)>&)>& work) {
  formats::ImportSummary s;
  {
    terminal::ProgressBar bar("importing " + label);
    s = work([&](double share) { bar.Show(share); });
  }
  std::printf(
      "%s: %.1f s, %lld events in %lld packets (%.2f million/s), %lld IMU samples, %lld truth poses\n",
      target.out.c_str(), s.seconds, static_cast<long long>(s.n_events), static_cast<long long>(s.n_packets),
      1e-6 * static_cast<double>(s.n_events) / s.seconds, static_cast<long long>(s.n_imu),
      static_cast<long long>(s.n_truth));
  PrintDropped(s.dropped_events, "events");
  PrintDropped(s.dropped_imu, "IMU samples");
  PrintDropped(s.dropped_truth, "truth poses");
  if (s.n_truth == 0) std::printf("no ground truth (%s): runs on it cannot be scored\n", no_truth.c_str());
}

void AddImportCommand(CLI::App* app) {
  CLI::App* import =
      app->add_subcommand("import", "Turn a recorded sequence into an LCM log")->require_subcommand(0, 1);
  AddImportRecording(import);
  AddImportVector(import);
  AddImportRpg(import);
  AddImportBag(import);
}

}  // namespace evit::commands
