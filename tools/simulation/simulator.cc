#include "tools/simulation/simulator.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/config/rig_file.h"
#include "common/map/map_file.h"
#include "tools/formats/hdf5/event_file_writer.h"
#include "tools/simulation/camera_frames.h"
#include "tools/simulation/edge_map.h"
#include "tools/simulation/event_stage.h"
#include "tools/simulation/load_motion.h"
#include "tools/simulation/place_in_room.h"
#include "tools/simulation/preview.h"
#include "tools/simulation/report.h"
#include "tools/simulation/rgbd_views.h"
#include "tools/simulation/room.h"
#include "tools/simulation/sequence_files.h"
#include "tools/simulation/staged_folder.h"

namespace evit::simulation {
namespace {

void Check(const SimulationSettings& s, const Rig& rig) {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw std::runtime_error(std::string("bad setting: ") + what);
  };
  require(!s.out.empty(), "no output folder");
  require(s.max_step_px >= 0.05 && s.max_step_px <= 1, "image step must be 0.05 to 1 px");
  require(s.sensor.threshold >= 0.02 && s.sensor.threshold <= 2, "contrast threshold must be 0.02 to 2");
  require(s.sensor.threshold_spread >= 0 && s.sensor.threshold_spread < 0.5,
          "threshold spread must be 0 to 0.5");
  require(s.sensor.low_pass_ms >= 0 && s.sensor.refractory_ms >= 0,
          "times of the sensor must not be negative");
  require(s.sensor.noise_hz >= 0 && s.sensor.noise_hz <= 1000, "noise must be 0 to 1000 Hz per pixel");
  require(s.sensor.hot_pixels >= 0 && s.sensor.hot_pixels <= 10000, "hot pixels must be 0 to 10000");
  require(s.imu.noise_factor >= 0 && s.imu.accel_bias >= 0 && s.imu.gyro_bias >= 0,
          "IMU errors must not be negative");
  require(s.map.voxel_m >= 1e-3 && s.map.voxel_m <= 1, "voxel must be 0.001 to 1 m");
  require(s.sensor.bright_grey >= 0 && s.sensor.leak_hz >= 0 && s.sensor.leak_hz <= 1000,
          "light and leaks of the sensor must not be negative, leaks at most 1000 Hz");
  require(s.sensor.threshold_drift >= 0 && s.sensor.threshold_drift <= 0.3,
          "threshold drift must be 0 to 0.3");
  require(s.optics.blur_px >= 0 && s.optics.blur_px <= 10, "lens blur must be 0 to 10 px");
  require(s.optics.saturation_grey >= 0, "saturation must not be negative");
  require(s.readout.burst_share >= 0 && s.readout.burst_share <= 0.9, "bursts must be 0 to 0.9");
  require(s.readout.rate_hz == 0 || s.readout.rate_hz >= 1e4, "readout must be 0 or at least 10000 events/s");
  require(s.imu.vibration_accel >= 0 && s.imu.vibration_gyro >= 0, "vibration must not be negative");
  const ImageMapSettings& images = s.map.images;
  require(images.scale >= 0.1 && images.scale <= 2,
          "the mapper's images must be 0.1 to 2 of the camera's size");
  require(images.grey_threshold > 0 && images.match_px >= 0,
          "the mapper's threshold must be over 0, errors not below");
  require(images.missing_share >= 0 && images.missing_share < 1, "missing pieces must be a share of 0 to 1");
  require(images.view_turn_deg >= 0 && images.view_turn_deg < 5, "a view's error must be 0 to 5 deg");
  require(s.frames.rate_hz >= 0 && s.frames.rate_hz <= 200, "frames must be 0 to 200 a second");
  require(s.frames.scale >= 0.1 && s.frames.scale <= 4, "frames must be 0.1 to 4 of the event camera's size");
  require(s.frames.exposure_ms >= 0 && s.frames.exposure_ms <= 50, "exposure must be 0 to 50 ms");
  require(s.map.interval_s >= 0.01, "map interval must be at least 0.01 s");
  require(s.map.holes.share >= 0 && s.map.holes.share < 1, "the share of holes in the map must be 0 to 1");
  require(s.map.holes.share == 0 || (s.map.holes.diameter_m >= 0.01 && s.map.holes.diameter_m <= 10),
          "holes in the map must be 0.01 to 10 m large");
  require(s.disturbances.dark_to_s >= s.disturbances.dark_from_s,
          "the lens must be covered before it is free again");
  require(!s.trajectory.carry.any() || s.disturbances.dark_to_s == s.disturbances.dark_from_s,
          "who carries the rig away covers the lens: leave the other darkness out");
  require(s.disturbances.lamp_share > 0 && s.disturbances.lamp_on_s >= s.disturbances.lamp_off_s,
          "lamp must go off before it comes on, to a share over 0");
  require(s.threads >= 1 && s.threads <= 256, "threads must be 1 to 256");
  require(s.previews >= 0 && s.previews <= 1000, "previews must be 0 to 1000");
  require(rig.camera.width >= 16 && rig.camera.height >= 16 && rig.imu_rate_hz > 0,
          "rig without camera or IMU rate");
}

// A map for events that were simulated before must be of the same motion in the same room.
void RequireSameSequence(const SimulationSettings& settings, const Motion& motion, const SimulatedImu& imu) {
  const std::filesystem::path folder(settings.out);
  const std::string other = settings.out + " holds another sequence (";
  const std::string remedy = "): give --map-only the options that sequence was made with, or another folder";
  if (std::filesystem::exists(folder / "truth.tum")) {
    const Trajectory truth = ReadTum((folder / "truth.tum").string());
    bool same = truth.size() == imu.samples.size();
    for (std::size_t i = 0; same && i < truth.size(); i += 20) {
      same = truth[i].t == imu.samples[i].t &&
             (truth[i].pose.p - motion.spline.Pose(truth[i].t).p).norm() < 1e-6;
    }
    if (!same) throw std::runtime_error(other + "truth.tum is of another motion" + remedy);
  }
  std::ifstream file(folder / "simulation.json");
  if (!file) return;
  const nlohmann::json report = nlohmann::json::parse(file, nullptr, false);
  if (report.is_discarded())
    throw std::runtime_error((folder / "simulation.json").string() +
                             ": is not valid JSON; simulate the sequence again");
  if (report.value("scene_seed", settings.room.seed) != settings.room.seed ||
      report.value("room", RoomName(settings.room.kind)) != RoomName(settings.room.kind)) {
    throw std::runtime_error(other + "simulation.json describes another room" + remedy);
  }
}

PointMap WriteMap(const SimulationSettings& settings, const Rig& rig, const Renderer& renderer,
                  const Motion& motion, const StagedFolder& folder, SimulationSummary* summary) {
  PointMap map = MakeEdgeMap(renderer, rig, motion.spline, motion.begin, motion.end, settings.map,
                             settings.seed, settings.threads, &summary->n_map_views);
  CutHoles(settings.map.holes, settings.seed, &map);
  if (map.points.empty()) throw std::runtime_error("the map would be empty: nothing with edges is in view");
  summary->n_map_points = map.points.size();
  WritePcd(folder.File("map.pcd"), map);
  if (settings.rgbd) {
    WriteRgbdViews(folder.File("rgbd"), renderer.scene(), rig, motion.spline,
                   ChooseMapViews(motion.spline, motion.begin, motion.end, settings.map), settings.map,
                   settings.seed, settings.threads);
  }
  return map;
}

// All edges that the camera passes, where they are: what maps are compared with.
MapSettings TrueEdges() {
  MapSettings settings;
  settings.interval_s = 0.05;
  settings.min_move_m = 0.05;
  settings.min_turn_deg = 5;
  settings.edge_threshold = 0.04;
  settings.depth_noise = settings.edge_noise_px = settings.view_jitter_m = settings.outlier_share = 0;
  settings.voxel_m = 0.002;
  settings.max_points = 5'000'000;
  return settings;
}

// What else was asked for of the same motion in the same room.
void WriteExtras(const SimulationSettings& settings, const Rig& rig, const Renderer& renderer,
                 const Motion& motion, const StagedFolder& folder,
                 const std::function<void(double)>& progress) {
  if (settings.true_edges) {
    int n_views = 0;
    WritePcd(folder.File("true_edges.pcd"),
             MakeEdgeMap(renderer, rig, motion.spline, motion.begin, motion.end, TrueEdges(), settings.seed,
                         settings.threads, &n_views));
  }
  if (settings.frames.rate_hz > 0) {
    WriteCameraFrames(folder.File(""), renderer.scene(), rig, motion.spline, motion.begin, motion.end,
                      settings.frames, settings.seed, settings.threads, progress);
  }
}

}  // namespace

SimulationSummary Simulate(const SimulationSettings& settings, const Rig& rig, const std::string& rig_name,
                           const std::function<void(double)>& progress) {
  const auto started = std::chrono::steady_clock::now();
  Check(settings, rig);
  const auto report = [&](double share) {
    if (progress) progress(share);
  };
  SimulationSummary summary;
  MotionSettings trajectory = settings.trajectory;
  trajectory.tremor_seed = settings.seed;
  summary.motion = LoadMotion(trajectory, rig);
  const Scene scene = MakeRoom(settings.room.seed, settings.room.kind);
  Motion& motion = summary.motion;
  PlaceInRoom(rig, scene, &motion);
  summary.motion_speed = MeasureMotionSpeed(motion, rig);
  summary.name = settings.name.empty() ? motion.name : settings.name;
  if (summary.name.find('/') != std::string::npos)
    throw std::runtime_error("sequence name must not contain '/'");
  summary.duration_s = ToSeconds(motion.end - motion.begin);
  StagedFolder folder(settings.out);
  const std::string base = summary.name + "1.synced";

  const SimulatedImu imu =
      SimulateImu(motion.spline, rig, settings.imu, motion.begin, motion.end, settings.seed);
  const Renderer renderer(rig.camera, scene);
  if (settings.map_only) {
    RequireSameSequence(settings, motion, imu);
    WriteMap(settings, rig, renderer, motion, folder, &summary);
    WriteExtras(settings, rig, renderer, motion, folder, report);
    folder.Commit();
    report(1);
    return summary;
  }
  WriteImuFile(folder.File(base + ".imu.txt"), imu);
  WriteGroundTruthFile(folder.File(base + ".gt.txt"), summary.name, motion, rig);
  WriteTruth(folder.File("truth.tum"), motion, imu);
  WriteRig(folder.File("rig.textproto"), rig, rig_name, "The rig that was simulated (evit simulate).");
  summary.n_imu = imu.samples.size();
  summary.first_bias = imu.biases.front();
  summary.last_bias = imu.biases.back();

  const RenderSchedule schedule = PlanRenders(motion.spline, rig, scene, motion.begin, motion.end,
                                              settings.max_step_px, settings.threads);
  summary.n_renders = schedule.times.size();
  summary.speed = schedule.speed;
  summary.mean_depth = schedule.mean_depth;
  report(0.02);
  const PointMap map = WriteMap(settings, rig, renderer, motion, folder, &summary);
  report(0.05);
  const double rest = settings.frames.rate_hz > 0 ? 0.6 : 0.94;  // of the time, for events
  WriteExtras(settings, rig, renderer, motion, folder,
              [&](double share) { report(0.05 + (0.94 - rest) * share); });

  const auto stamp = [&](double seconds) { return motion.begin + static_cast<Utime>(seconds * 1e6); };
  Disturbances disturbances;
  disturbances.lamp.off = stamp(settings.disturbances.lamp_off_s);
  disturbances.lamp.on = stamp(settings.disturbances.lamp_on_s);
  disturbances.lamp.share = settings.disturbances.lamp_share;
  const Carry& carry = settings.trajectory.carry;
  disturbances.cover.from = stamp(carry.any() ? carry.from_s : settings.disturbances.dark_from_s);
  disturbances.cover.to = stamp(carry.any() ? carry.to_s : settings.disturbances.dark_to_s);
  std::unique_ptr<MovingBox> box;
  if (settings.disturbances.moving_box)
    box = std::make_unique<MovingBox>(settings.seed, motion.spline, rig, motion.begin, motion.end);
  disturbances.box = box.get();
  Preview preview(renderer, rig, motion.spline, motion.begin, motion.end, settings.previews, box.get());
  // Event stamps are in the camera's clock.
  formats::EventFileWriter writer(folder.File(base + ".left_event.hdf5"),
                                  motion.begin - rig.camera_time_offset);
  EventArray shifted;
  summary.events = SimulateEvents(
      renderer, motion.spline, rig, schedule, disturbances,
      {settings.optics, settings.sensor, settings.readout}, settings.seed, settings.threads,
      [&](const EventArray& events) {
        preview.Add(events);
        shifted = events;
        for (Utime& t : shifted.t) t -= rig.camera_time_offset;
        writer.Append(shifted);
      },
      [&](double share) { report(0.99 - rest * (1 - share)); });
  writer.Close();
  preview.Write(map, [&](const std::string& name) { return folder.File(name); });
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  WriteReport(folder.File("simulation.json"), settings, summary);
  folder.Commit();
  report(1);
  return summary;
}

}  // namespace evit::simulation
