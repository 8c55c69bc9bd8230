#include "tools/evit/import_options.h"

#include <csignal>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/imu/standard_gravity.h"
#include "tools/evit/interruptible.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/formats/import/import_doubts.h"

namespace evit::commands {
namespace {

// In m/s^2 and rad/s.
const std::map<std::string, double> kAccelUnits{
    {"m/s^2", 1}, {"g", kStandardGravity}, {"mg", 1e-3 * kStandardGravity}};
const std::map<std::string, double> kGyroUnits{{"rad/s", 1}, {"deg/s", 0.017453292519943295}};

std::vector<std::string> UnitNames(const std::map<std::string, double>& units) {
  std::vector<std::string> names;
  names.reserve(units.size());
  for (const auto& [name, scale] : units) names.push_back(name);
  return names;
}

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
      "16 numbers, row-major 4x4, from the ground truth's frame to the map's (default: identity)");
  source->add_option("--seconds", seconds, "A:B in s after the first event, take only this part");
  source->add_option("--accel-unit", accel_unit, "The accelerometer's unit")
      ->check(CLI::IsMember(UnitNames(kAccelUnits)))
      ->capture_default_str();
  source->add_option("--gyro-unit", gyro_unit, "The gyro's unit")
      ->check(CLI::IsMember(UnitNames(kGyroUnits)))
      ->capture_default_str();
  source->add_flag("--any-imu", any_imu, "Take the IMU even where its units or columns look wrong");
}

void ImportOptions::Apply(formats::ImportTarget* target) const {
  target->out = out;
  target->accel_scale = kAccelUnits.at(accel_unit);
  target->gyro_scale = kGyroUnits.at(gyro_unit);
  target->any_imu = any_imu;
  if (!transform.empty()) target->T_map_world = ParseTransform("--T-map-world", transform);
  if (!seconds.empty()) target->seconds = ParseSeconds(seconds);
}

void RunImport(const std::string& label, const formats::ImportTarget& target, const std::string& no_truth,
               const std::function<formats::ImportSummary(const std::function<void(double)>&)>& work) {
  formats::ImportSummary s;
  RequireLogOutput("--out", target.out);                // said before a long recording is read
  std::signal(SIGPIPE, SIG_IGN);                        // with `| head` the log is still written whole
  std::fprintf(stderr, "reading %s\n", label.c_str());  // a bag is gone through before the first event
  RunInterruptibly("evit import", "importing " + label, [&](const auto& report) { s = work(report); });
  std::printf(
      "%s: %.1f s, %lld events in %lld packets (%.2f million/s), %lld IMU samples, %lld truth poses\n",
      target.out.c_str(), s.seconds, static_cast<long long>(s.n_events), static_cast<long long>(s.n_packets),
      s.seconds > 0 ? 1e-6 * static_cast<double>(s.n_events) / s.seconds : 0, static_cast<long long>(s.n_imu),
      static_cast<long long>(s.n_truth));
  PrintDropped(s.dropped_events, "events");
  PrintDropped(s.dropped_imu, "IMU samples");
  PrintDropped(s.dropped_truth, "truth poses");
  constexpr double kShort = 0.05;  // s
  if (s.seconds < kShort && s.n_events >= 1000 && !s.dropped_events.cut_off)
    std::printf(
        "only %.6f s long: if it is longer, name the unit of its stamps in the head (t_ms, t_us, t_ns)\n",
        s.seconds);
  for (const std::string& doubt : formats::DoubtsOf(s)) std::fprintf(stderr, "warning: %s\n", doubt.c_str());
  if (s.n_truth == 0) std::printf("no ground truth (%s): runs on it cannot be scored\n", no_truth.c_str());
}

}  // namespace evit::commands
