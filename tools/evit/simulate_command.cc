#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/config/rig_file.h"
#include "common/geometry/degrees.h"
#include "common/geometry/se3.h"
#include "tools/evit/commands.h"
#include "tools/evit/data_file.h"
#include "tools/evit/interruptible.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/evit/simulate_options.h"
#include "tools/simulation/load_motion.h"
#include "tools/simulation/simulator.h"

namespace evit::commands {
namespace {

// A file's poses are not those of truth.tum: the path is put into the room.
void PrintPlace(const SE3& T_map_source) {
  const Eigen::Vector3d turn = LogSO3(T_map_source.q);
  std::printf("path turned by %.1f deg about z, then moved by (%.2f, %.2f, %.2f) m, to fit the room\n",
              kDegreesPerRadian * turn.z(), T_map_source.p.x(), T_map_source.p.y(), T_map_source.p.z());
}

void PrintSummary(const simulation::SimulationSettings& settings, const simulation::SimulationSummary& s) {
  std::printf("%s: %.2f s; %s; spline fits to %.2f mm, %.3f deg\n", s.name.c_str(), s.duration_s,
              s.motion.note.c_str(), 1e3 * s.motion.fit_rms_m, s.motion.fit_rms_deg);
  if (!simulation::IsBuiltin(settings.trajectory)) PrintPlace(s.motion.T_map_source);
  const simulation::MotionSpeed& v = s.motion_speed;
  std::printf("camera %.2f m/s and %.2f rad/s mean, %.2f and %.2f at the 99th percentile\n", v.mean,
              v.turn_mean, v.p99, v.turn_p99);
  std::printf("image speed %.0f px/s mean, %.0f at most; depth %.2f m mean; %zu renders\n", s.speed.mean,
              s.speed.max, s.mean_depth, s.n_renders);
  std::printf(
      "events %zu (%.2f million/s mean, %.2f peak; %.2f noise), IMU samples %zu, map points %zu of %d "
      "views\n",
      s.events.total(), 1e-6 * static_cast<double>(s.events.total()) / s.duration_s,
      1e-6 * s.events.peak_rate, 1e-6 * static_cast<double>(s.events.noise) / s.duration_s, s.n_imu,
      s.n_map_points, s.n_map_views);
  std::printf("%.1f s wall; written to %s\n", s.wall_s, settings.out.c_str());
}

void Run(const SimulateOptions& options) {
  simulation::SimulationSettings settings = options.Settings();
  RequireOutputFolder("--out", settings.out);
  settings.command = CommandLineOfThis();
  const std::string rig = options.rig().empty() ? DataFile("config/vector/rig.textproto") : options.rig();
  simulation::SimulationSummary summary;
  RunInterruptibly("evit simulate", "simulating", [&](const auto& report) {
    summary = simulation::Simulate(
        settings, LoadRig(rig), "simulated, from " + std::filesystem::path(rig).filename().string(), report);
  });
  if (settings.map_only) {
    std::printf("%s: map points %zu of %d views, written to %s\n", summary.name.c_str(), summary.n_map_points,
                summary.n_map_views, settings.out.c_str());
    return;
  }
  PrintSummary(settings, summary);
}

}  // namespace

void AddSimulateCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("simulate", "Simulate an event camera and an IMU in a furnished room");
  const auto options = std::make_shared<SimulateOptions>();
  options->AddTo(command);
  command->callback([options] { Run(*options); });
}

}  // namespace evit::commands
