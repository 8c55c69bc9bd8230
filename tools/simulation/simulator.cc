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
#include "tools/simulation/settings_check.h"
#include "tools/simulation/staged_folder.h"

namespace evit::simulation {
namespace {

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

// What the body feels, and where it truly is.
void WriteBody(const Rig& rig, const std::string& rig_name, const SimulatedImu& imu, const std::string& base,
               const StagedFolder& folder, SimulationSummary* summary) {
  const Motion& motion = summary->motion;
  WriteImuFile(folder.File(base + ".imu.txt"), imu);
  WriteGroundTruthFile(folder.File(base + ".gt.txt"), summary->name, motion, rig);
  WriteTruth(folder.File("truth.tum"), motion, imu);
  Rig exact = rig;
  exact.T_body_camera_sigma = {};  // as well as it is known elsewhere: this is the truth
  WriteRig(folder.File("rig.textproto"), exact, rig_name, "The rig that was simulated (evit simulate).");
  summary->n_imu = imu.samples.size();
  summary->first_bias = imu.biases.front();
  summary->last_bias = imu.biases.back();
}

// Of the light; the box that moves is the caller's.
Disturbances LightOf(const SimulationSettings& settings, Utime begin) {
  const auto stamp = [&](double seconds) { return begin + static_cast<Utime>(seconds * 1e6); };
  Disturbances disturbances;
  disturbances.lamp.off = stamp(settings.disturbances.lamp_off_s);
  disturbances.lamp.on = stamp(settings.disturbances.lamp_on_s);
  disturbances.lamp.share = settings.disturbances.lamp_share;
  const Carry& carry = settings.trajectory.carry;
  disturbances.cover.from = stamp(carry.any() ? carry.from_s : settings.disturbances.dark_from_s);
  disturbances.cover.to = stamp(carry.any() ? carry.to_s : settings.disturbances.dark_to_s);
  return disturbances;
}

// The events, and pictures of them with `map`.
void WriteEvents(const SimulationSettings& settings, const Rig& rig, const Renderer& renderer,
                 const RenderSchedule& schedule, const PointMap& map, const std::string& base,
                 const StagedFolder& folder, const std::function<void(double)>& progress,
                 SimulationSummary* summary) {
  const Motion& motion = summary->motion;
  Disturbances disturbances = LightOf(settings, motion.begin);
  std::unique_ptr<MovingBox> box;
  if (settings.disturbances.moving_box)
    box = std::make_unique<MovingBox>(settings.seed, motion.spline, rig, motion.begin, motion.end);
  disturbances.box = box.get();
  Preview preview(renderer, rig, motion.spline, motion.begin, motion.end, settings.previews, box.get());
  // Event stamps are in the camera's clock.
  formats::EventFileWriter writer(folder.File(base + ".left_event.hdf5"),
                                  motion.begin - rig.camera_time_offset);
  EventArray shifted;
  summary->events = SimulateEvents(
      renderer, motion.spline, rig, schedule, disturbances,
      {settings.optics, settings.sensor, settings.readout}, settings.seed, settings.threads,
      [&](const EventArray& events) {
        preview.Add(events);
        shifted = events;
        for (Utime& t : shifted.t) t -= rig.camera_time_offset;
        writer.Append(shifted);
      },
      progress);
  writer.Close();
  preview.Write(map, [&](const std::string& name) { return folder.File(name); });
}

// The motion in its room, and what is known of it.
SimulationSummary Place(const SimulationSettings& settings, const Rig& rig, const Scene& scene) {
  SimulationSummary summary;
  MotionSettings trajectory = settings.trajectory;
  trajectory.tremor_seed = settings.seed;
  summary.motion = LoadMotion(trajectory, rig);
  PlaceInRoom(rig, scene, &summary.motion);
  summary.motion_speed = MeasureMotionSpeed(summary.motion, rig);
  summary.name = settings.name.empty() ? summary.motion.name : settings.name;
  if (summary.name.find('/') != std::string::npos)
    throw std::runtime_error("sequence name must not contain '/'");
  summary.duration_s = ToSeconds(summary.motion.end - summary.motion.begin);
  return summary;
}

}  // namespace

SimulationSummary Simulate(const SimulationSettings& settings, const Rig& rig, const std::string& rig_name,
                           const std::function<void(double)>& progress) {
  const auto started = std::chrono::steady_clock::now();
  CheckSettings(settings, rig);
  const auto report = [&](double share) {
    if (progress) progress(share);
  };
  const Scene scene = MakeRoom(settings.room.seed, settings.room.kind);
  SimulationSummary summary = Place(settings, rig, scene);
  const Motion& motion = summary.motion;
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
  WriteBody(rig, rig_name, imu, base, folder, &summary);
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
  WriteEvents(
      settings, rig, renderer, schedule, map, base, folder,
      [&](double share) { report(0.99 - rest * (1 - share)); }, &summary);
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  WriteReport(folder.File("simulation.json"), settings, summary);
  folder.Commit();
  report(1);
  return summary;
}

}  // namespace evit::simulation
