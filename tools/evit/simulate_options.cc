#include "tools/evit/simulate_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <thread>
#include <vector>

#include "tools/simulation/builtin_motion.h"
#include "tools/simulation/profile.h"

namespace evit::commands {
namespace {

// "1:2.5:3" into as many numbers as there are values; false where the text has another form.
bool ParseNumbers(const std::string& text, const std::vector<double*>& values) {
  const char* at = text.c_str();
  for (std::size_t k = 0; k < values.size(); ++k) {
    char* end = nullptr;
    *values[k] = std::strtod(at, &end);
    const char stop = k + 1 < values.size() ? ':' : '\0';
    if (end == at || *end != stop || !std::isfinite(*values[k])) return false;
    at = end + 1;
  }
  return true;
}

bool ParseRange(const std::string& text, double* from, double* to) {
  return ParseNumbers(text, {from, to}) && *from >= 0 && *to > *from;
}

bool ParseTremor(const std::string& text, simulation::Tremor* tremor) {
  return ParseNumbers(text, {&tremor->hz, &tremor->mm, &tremor->deg});
}

bool ParseCarry(const std::string& text, simulation::Carry* carry) {
  double degrees = 0;
  if (!ParseNumbers(text, {&carry->from_s, &carry->to_s, &carry->dx, &carry->dy, &degrees})) return false;
  carry->yaw = degrees * 3.14159265358979 / 180;
  return carry->from_s >= 0 && carry->to_s >= carry->from_s + 0.5;
}

bool ParseHoles(const std::string& text, simulation::MapHoles* holes) {
  return ParseNumbers(text, {&holes->share, &holes->diameter_m});
}

// Accepts texts that `parse` reads; `form`: for --help, `expected`: for the message.
CLI::Validator Form(const std::string& form, const std::string& expected,
                    const std::function<bool(const std::string&)>& parse) {
  return CLI::Validator(
      [=](const std::string& text) {
        return parse(text) ? std::string() : "'" + text + "': expected " + expected;
      },
      form);
}

CLI::Validator RangeForm() {
  return Form("FROM:TO", "FROM:TO in seconds, 0 <= FROM < TO", [](const std::string& text) {
    double from = 0, to = 0;
    return ParseRange(text, &from, &to);
  });
}

// Adds options that belong together: a group of --help.
class Group {
 public:
  Group(CLI::App* command, std::string name) : command_(command), name_(std::move(name)) {}

  template <typename Value>
  CLI::Option* Add(const char* option, Value* value, const char* help) const {
    return command_->add_option(option, *value, help)->group(name_);
  }
  void Flag(const char* flag, bool* value, const char* help) const {
    command_->add_flag(flag, *value, help)->group(name_);
  }

 private:
  CLI::App* command_;
  std::string name_;
};

}  // namespace

void SimulateOptions::AddTo(CLI::App* command) {
  simulation::SimulationSettings& s = settings_;
  s.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
  command->option_defaults()->always_capture_default();
  command->add_option("--trajectory", s.trajectory.source, "TUM file, or " + simulation::BuiltinMotionNames())
      ->required();
  // At once when it is read, so that options beside it, which are set at the end, have the last word.
  command
      ->add_option_function<std::string>(
          "--profile",
          [this](const std::string& name) {
            settings_.profile = name;
            simulation::Profile profile{};
            simulation::ProfileFromName(name, &profile);
            simulation::ApplyProfile(profile, &settings_);
          },
          "Errors of sensor and map: ideal; camera-map: the map of an image-based mapper; sensor: latency by "
          "light, "
          "drift, bursts, blur, vibration; real: both")
      ->check(CLI::IsMember({"ideal", "camera-map", "sensor", "real"}))
      ->trigger_on_parse();
  command->add_option("--scene", s.room.seed, "Seed of the room");
  command->add_option("--out", s.out, "Folder to write")->required();
  command->add_option("--name", s.name, "Name of the sequence (default: of the trajectory)");
  command->add_option("--rig", rig_, "Rig file (default: VECtor's)");
  command->add_option("--seed", s.seed, "Seed of all noise");
  command->add_option("--threads", s.threads, "Threads; the result is the same with any number");
  command->add_option("--preview", s.previews, "Pictures to write: image | events | map on events");
  AddWorld(command);
  AddMotion(command);
  AddSensors(command);
  AddMap(command);
  command->footer(
      "Example: evit simulate --trajectory builtin:desk_normal --duration 5 --out desk\n"
      "makes desk/desk_normal1.synced.* (for evit import vector), desk/map.pcd, desk/rig.textproto and\n"
      "desk/truth.tum.");
}

void SimulateOptions::AddWorld(CLI::App* command) {
  simulation::DisturbanceSettings& s = settings_.disturbances;
  const Group group(command, "World");
  group.Add("--lamp", &lamp_, "The lamp is off in this time, s (--lamp-share of the light remains)")
      ->check(RangeForm());
  group.Add("--dark", &dark_, "The lens is covered in this time, s; covering and opening take 0.1 s each")
      ->check(RangeForm());
  group.Add("--room", &room_, "furnished, or plain: almost no texture")
      ->check(CLI::IsMember({"furnished", "plain"}));
  group.Flag("--moving-box", &s.moving_box, "A textured box moves before the camera; it is not in the map");
  group.Add("--lamp-share", &s.lamp_share, "Share of the light that remains");
}

void SimulateOptions::AddMotion(CLI::App* command) {
  simulation::MotionSettings& s = settings_.trajectory;
  const Group group(command, "Motion");
  group.Add("--seconds", &seconds_, "Part of the trajectory file, s from its start (in the file's time)")
      ->check(RangeForm());
  group.Add("--duration", &s.duration_s, "Length of a builtin trajectory, s");
  group.Add("--play-speed", &s.play_speed, "Play the trajectory this many times faster");
  group.Add("--tremor", &tremor_, "A hand's tremor on top: frequency and amplitudes, e.g. 7:7:1.1")
      ->check(Form("HZ:MM:DEG", "HZ:MM:DEG, e.g. 7:7:1.1", [](const std::string& text) {
        simulation::Tremor tremor;
        return ParseTremor(text, &tremor);
      }));
  group
      .Add("--carry", &carry_,
           "Between A and B (s, half a second apart or more) the lens is covered and the rig carried away: "
           "X and Y m on, turned by DEG about the vertical")
      ->check(Form("A:B:X:Y:DEG", "A:B:X:Y:DEG, e.g. 2:3.5:1.5:-1:120", [](const std::string& text) {
        simulation::Carry carry;
        return ParseCarry(text, &carry);
      }));
  group.Add("--motion-seed", &s.variant, "Variant of a builtin trajectory, from 1");
  group.Add("--trajectory-frame", &frame_, "What the file's poses are")
      ->check(CLI::IsMember({"auto", "body", "marker-yup"}));
  group.Add("--knot-ms", &s.knot_ms, "Knot spacing of the smoothing spline");
}

void SimulateOptions::AddSensors(CLI::App* command) {
  simulation::EventSensorSettings& s = settings_.sensor;
  const Group camera(command, "Event camera");
  camera.Add("--threshold", &s.threshold, "Contrast threshold, of log intensity");
  camera.Add("--threshold-spread", &s.threshold_spread, "Its standard deviation over pixels, share");
  camera.Add("--low-pass-ms", &s.low_pass_ms, "Time constant of the photoreceptor");
  camera.Add("--refractory-ms", &s.refractory_ms, "Refractory time");
  camera.Add("--bright-grey", &s.bright_grey,
             "Light (0..255) at which --low-pass-ms holds, darker is slower; 0: alike");
  camera.Add("--threshold-drift", &s.threshold_drift, "Drift of all thresholds over seconds, share");
  camera.Add("--leak-hz", &s.leak_hz, "Brighter events of a pixel that sees no change");
  camera.Add("--lens-blur", &settings_.optics.blur_px, "Blur of the lens, px");
  camera.Add("--saturation", &settings_.optics.saturation_grey,
             "Light (0..255) beyond which nothing changes; 0: none");
  camera.Add("--burst-share", &settings_.readout.burst_share,
             "Events that are followed by another of their pixel, share");
  camera.Add("--readout-hz", &settings_.readout.rate_hz,
             "Events read out in a second at most; 0: any number");
  camera.Add("--noise-hz", &s.noise_hz, "Background events per pixel and second");
  camera.Add("--hot-pixels", &s.hot_pixels, "Number of hot pixels");
  camera.Add("--max-step-px", &settings_.max_step_px, "Image motion between renders");
  const Group frames(command, "Regular camera");
  frames.Add(
      "--frames", &settings_.frames.rate_hz,
      "Pictures a second of a regular camera at the event camera's place: camera/, camera_poses.tum and "
      "camera.textproto; 0: none");
  frames.Add("--frame-scale", &settings_.frames.scale, "Their size, share of the event camera's");
  frames.Add("--frame-exposure", &settings_.frames.exposure_ms, "ms; longer ones blur");
  frames.Add("--frame-noise", &settings_.frames.grey_noise, "Grey levels");
  const Group imu(command, "IMU");
  imu.Add("--accel-bias", &settings_.imu.accel_bias, "Initial bias, m/s^2, in a random direction");
  imu.Add("--gyro-bias", &settings_.imu.gyro_bias, "Initial bias, rad/s, in a random direction");
  imu.Add("--vibration-accel", &settings_.imu.vibration_accel,
          "Vibration of the mount, m/s^2 rms of an axis");
  imu.Add("--vibration-gyro", &settings_.imu.vibration_gyro, "The same, rad/s");
  imu.Add("--imu-noise", &settings_.imu.noise_factor, "Factor on the rig's noise densities");
}

void SimulateOptions::AddMap(CLI::App* command) {
  simulation::MapSettings& s = settings_.map;
  const Group group(command, "Map");
  group.Add("--map-interval", &s.interval_s, "Seconds between the views considered");
  group.Add("--map-depth-noise", &s.depth_noise, "Share of the depth");
  group.Add("--map-edge-noise", &s.edge_noise_px, "px across the edge");
  group.Add("--map-view-jitter", &s.view_jitter_m, "m, per axis of a view's position");
  group.Add("--map-outliers", &s.outlier_share, "Share of outliers");
  group.Add("--map-outlier-distance", &s.outlier_m, "m");
  group.Add("--map-voxel", &s.voxel_m, "m");
  simulation::ImageMapSettings& images = s.images;
  group.Flag("--map-from-images", &images.on,
             "As an image-based mapper makes it; the options above but for the voxel do not count");
  group.Add("--map-image-scale", &images.scale, "Size of the mapper's images, share of the event camera's");
  group.Add("--map-grey-threshold", &images.grey_threshold, "Grey levels per pixel: an edge in an image");
  group.Add("--map-match-px", &images.match_px,
            "Error of a match along the epipolar line, px of the mapper's image");
  group.Add("--map-missing", &images.missing_share, "Share of pieces of edges that find no match");
  group.Add("--map-view-turn", &images.view_turn_deg, "Error of a mapper's view, deg per axis");
  group.Add("--map-max-points", &s.max_points, "Points kept at most");
  group.Add("--map-holes", &holes_, "This share of the map is missing, in balls of this diameter")
      ->check(Form("SHARE:METRES", "SHARE:METRES, e.g. 0.5:0.6", [](const std::string& text) {
        simulation::MapHoles holes;
        return ParseHoles(text, &holes);
      }));
  group.Flag("--map-only", &settings_.map_only,
             "Write map.pcd (and rgbd/, camera/, true_edges.pcd) alone: another map for a sequence simulated "
             "before with the same "
             "options");
  group.Flag("--true-edges", &settings_.true_edges,
             "Also write true_edges.pcd: all edges in view, dense and without errors, to compare maps with");
  group.Flag("--rgbd", &settings_.rgbd,
             "Also write the map's views: rgbd/{images,depth}/*.png, poses.txt, K.txt (grey; depth in mm, 16 "
             "bit)");
}

simulation::SimulationSettings SimulateOptions::Settings() const {
  simulation::SimulationSettings s = settings_;
  if (frame_ == "body") s.trajectory.frame = simulation::TrajectoryFrame::kBody;
  if (frame_ == "marker-yup") s.trajectory.frame = simulation::TrajectoryFrame::kMarkerYUp;
  if (!seconds_.empty()) ParseRange(seconds_, &s.trajectory.begin_s, &s.trajectory.end_s);
  if (!tremor_.empty()) ParseTremor(tremor_, &s.trajectory.tremor);
  if (!carry_.empty()) ParseCarry(carry_, &s.trajectory.carry);
  if (!holes_.empty()) ParseHoles(holes_, &s.map.holes);
  if (!dark_.empty()) ParseRange(dark_, &s.disturbances.dark_from_s, &s.disturbances.dark_to_s);
  if (!lamp_.empty()) ParseRange(lamp_, &s.disturbances.lamp_off_s, &s.disturbances.lamp_on_s);
  s.room.kind = room_ == "plain" ? simulation::RoomKind::kPlain : simulation::RoomKind::kFurnished;
  return s;
}

}  // namespace evit::commands
