#include "tools/evit/simulate_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "common/config/rig_file.h"
#include "tools/evit/data_file.h"
#include "tools/simulation/builtin_motion.h"
#include "tools/simulation/simulator.h"

namespace evit::commands {
namespace {

struct Options {
  simulation::SimulationSettings settings;
  std::string rig_path, frame = "auto", seconds, lamp, dark, tremor, holes;
  std::string room = "furnished";
};

// "A:B" in seconds.
bool ParseRange(const std::string& text, double* a, double* b) {
  char rest = 0;
  return std::sscanf(text.c_str(), "%lf:%lf%c", a, b, &rest) == 2 && *a >= 0 && *b > *a;
}

bool ParseTremor(const std::string& text, simulation::Tremor* tremor) {
  char rest = 0;
  return std::sscanf(text.c_str(), "%lf:%lf:%lf%c", &tremor->hz, &tremor->mm, &tremor->deg, &rest) == 3;
}

const CLI::Validator kTremor(
    [](const std::string& text) {
      simulation::Tremor tremor;
      return ParseTremor(text, &tremor) ? std::string() : "'" + text + "': must be HZ:MM:DEG, e.g. 7:7:1.1";
    },
    "HZ:MM:DEG");

bool ParseHoles(const std::string& text, simulation::MapHoles* holes) {
  char rest = 0;
  return std::sscanf(text.c_str(), "%lf:%lf%c", &holes->share, &holes->diameter_m, &rest) == 2;
}

const CLI::Validator kHoles(
    [](const std::string& text) {
      simulation::MapHoles holes;
      return ParseHoles(text, &holes) ? std::string() : "'" + text + "': must be SHARE:METRES, e.g. 0.5:0.6";
    },
    "SHARE:METRES");

const CLI::Validator kRange(
    [](const std::string& text) {
      double a = 0, b = 0;
      return ParseRange(text, &a, &b) ? std::string()
                                      : "'" + text + "': must be FROM:TO in seconds, 0 <= FROM < TO";
    },
    "FROM:TO");

void PrintProgress(double share) {
  constexpr int kWidth = 40;
  const int done = static_cast<int>(share * kWidth);
  std::fprintf(stderr, "\r[%s%s] %3d %%%s", std::string(done, '#').c_str(),
               std::string(kWidth - done, '.').c_str(), static_cast<int>(share * 100),
               share >= 1 ? "\n" : "");
}

void PrintSummary(const simulation::SimulationSettings& settings, const simulation::SimulationSummary& s) {
  std::printf("%s: %.2f s; %s; spline fits to %.2f mm, %.3f deg\n", s.name.c_str(), s.duration_s,
              s.motion.note.c_str(), 1e3 * s.motion.fit_rms_m, s.motion.fit_rms_deg);
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

void Run(Options* options) {
  simulation::SimulationSettings& s = options->settings;
  const std::string rig_path =
      options->rig_path.empty() ? DataFile("config/vector/rig.textproto") : options->rig_path;
  const Rig rig = LoadRig(rig_path);
  if (options->frame == "body") s.trajectory.frame = simulation::TrajectoryFrame::kBody;
  if (options->frame == "marker-yup") s.trajectory.frame = simulation::TrajectoryFrame::kMarkerYUp;
  if (!options->seconds.empty()) ParseRange(options->seconds, &s.trajectory.begin_s, &s.trajectory.end_s);
  if (!options->tremor.empty()) ParseTremor(options->tremor, &s.trajectory.tremor);
  if (!options->holes.empty()) ParseHoles(options->holes, &s.map_holes);
  if (!options->dark.empty()) ParseRange(options->dark, &s.dark_from_s, &s.dark_to_s);
  s.room = options->room == "plain" ? simulation::RoomKind::kPlain : simulation::RoomKind::kFurnished;
  if (!options->lamp.empty()) ParseRange(options->lamp, &s.lamp_off_s, &s.lamp_on_s);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const simulation::SimulationSummary summary =
      simulation::Simulate(s, rig, "simulated, from " + std::filesystem::path(rig_path).filename().string(),
                           terminal ? std::function<void(double)>(PrintProgress) : nullptr);
  if (s.map_only) {
    std::printf("%s: map points %zu of %d views, written to %s\n", summary.name.c_str(), summary.n_map_points,
                summary.n_map_views, s.out.c_str());
    return;
  }
  PrintSummary(s, summary);
}

}  // namespace

void AddSimulateCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("simulate", "Simulate an event camera and an IMU in a furnished room");
  const auto options = std::make_shared<Options>();
  simulation::SimulationSettings& s = options->settings;
  s.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
  command->option_defaults()->always_capture_default();
  command->add_option("--trajectory", s.trajectory.source, "TUM file, or " + simulation::BuiltinMotionNames())
      ->required();
  command->add_option("--scene", s.scene_seed, "Seed of the room");
  command->add_option("--out", s.out, "Folder to write")->required();
  command->add_option("--name", s.name, "Name of the sequence (default: of the trajectory)");
  command->add_option("--rig", options->rig_path, "Rig file (default: VECtor's)")->check(CLI::ExistingFile);
  command->add_option("--seed", s.seed, "Seed of all noise");
  command->add_option("--threads", s.threads, "Threads; the result is the same with any number");
  command->add_option("--preview", s.previews, "Pictures to write: image | events | map on events");
  command
      ->add_option("--lamp", options->lamp,
                   "The lamp goes off and on again, s (--lamp-share of the light stays)")
      ->check(kRange)
      ->group("World");
  command->add_option("--dark", options->dark, "The lens is covered, s; it takes 0.1 s before and after")
      ->check(kRange)
      ->group("World");
  command->add_option("--room", options->room, "furnished, or plain: hardly any texture")
      ->check(CLI::IsMember({"furnished", "plain"}))
      ->group("World");
  command
      ->add_flag("--moving-box", s.moving_box, "A textured box moves before the camera; it is not in the map")
      ->group("World");
  command->add_option("--lamp-share", s.lamp_share, "Share of the light that stays")->group("World");

  command
      ->add_option("--seconds", options->seconds,
                   "Part of the trajectory file, s from its start (in the file's time)")
      ->check(kRange)
      ->group("Motion");
  command->add_option("--duration", s.trajectory.duration_s, "Length of a builtin trajectory, s")
      ->group("Motion");
  command->add_option("--play-speed", s.trajectory.play_speed, "Play the trajectory this many times faster")
      ->group("Motion");
  command
      ->add_option("--tremor", options->tremor,
                   "A hand's tremor on top: frequency and amplitudes, e.g. 7:7:1.1")
      ->check(kTremor)
      ->group("Motion");
  command->add_option("--motion-seed", s.trajectory.variant, "Variant of a builtin trajectory, from 1")
      ->group("Motion");
  command->add_option("--trajectory-frame", options->frame, "What the file's poses are")
      ->check(CLI::IsMember({"auto", "body", "marker-yup"}))
      ->group("Motion");
  command->add_option("--knot-ms", s.trajectory.knot_ms, "Knot spacing of the smoothing spline")
      ->group("Motion");

  const auto add = [&](const char* group, const char* name, auto* value, const char* text) {
    command->add_option(name, *value, text)->group(group);
  };
  add("Event camera", "--threshold", &s.sensor.threshold, "Contrast threshold, of log intensity");
  add("Event camera", "--threshold-spread", &s.sensor.threshold_spread, "Its deviation over pixels, share");
  add("Event camera", "--low-pass-ms", &s.sensor.low_pass_ms, "Time constant of the photoreceptor");
  add("Event camera", "--refractory-ms", &s.sensor.refractory_ms, "Refractory time");
  add("Event camera", "--noise-hz", &s.sensor.noise_hz, "Background events per pixel and second");
  add("Event camera", "--hot-pixels", &s.sensor.hot_pixels, "Number of hot pixels");
  add("Event camera", "--max-step-px", &s.max_step_px, "Image motion between renders");
  add("IMU", "--accel-bias", &s.imu.accel_bias, "Initial bias, m/s^2, in a random direction");
  add("IMU", "--gyro-bias", &s.imu.gyro_bias, "Initial bias, rad/s, in a random direction");
  add("IMU", "--imu-noise", &s.imu.noise_factor, "Factor on the rig's noise densities");
  add("Map", "--map-interval", &s.map.interval_s, "Seconds between views considered");
  add("Map", "--map-depth-noise", &s.map.depth_noise, "Share of the depth");
  add("Map", "--map-edge-noise", &s.map.edge_noise_px, "px across the edge");
  add("Map", "--map-view-jitter", &s.map.view_jitter_m, "m, per axis of a view's position");
  add("Map", "--map-outliers", &s.map.outlier_share, "Share of outliers");
  add("Map", "--map-outlier-distance", &s.map.outlier_m, "m");
  add("Map", "--map-voxel", &s.map.voxel_m, "m");
  add("Map", "--map-max-points", &s.map.max_points, "Points kept at most");
  command
      ->add_option("--map-holes", options->holes,
                   "This share of the map is missing, in balls of this diameter")
      ->check(kHoles)
      ->group("Map");
  command
      ->add_flag("--map-only", s.map_only,
                 "Write map.pcd (and rgbd/) alone: another map for a sequence simulated before with the same "
                 "options")
      ->group("Map");
  command
      ->add_flag("--rgbd", s.rgbd,
                 "Also write the map's views: rgbd/{images,depth}/*.png, poses.txt, K.txt (grey; depth in "
                 "mm, 16 bit)")
      ->group("Map");

  command->callback([options, app] {
    // The words as typed are not kept by the parser; what it read is.
    options->settings.command =
        "evit simulate\n" + app->get_subcommand("simulate")->config_to_str(false, false);
    Run(options.get());
  });
}

}  // namespace evit::commands
