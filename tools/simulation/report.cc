#include "tools/simulation/report.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/geometry/so3.h"

namespace evit::simulation {
namespace {

using Json = nlohmann::ordered_json;

Json Numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json TrajectoryJson(const MotionSettings& settings, const SimulationSummary& s) {
  const Tremor& tremor = settings.tremor;
  const Carry& carry = settings.carry;
  return {
      {"source", settings.source},
      {"note", s.motion.note},
      {"begin_us", s.motion.begin},
      {"duration_s", s.duration_s},
      {"knot_ms", settings.knot_ms},
      {"play_speed", settings.play_speed},
      {"variant", settings.variant},
      {"tremor_hz", tremor.hz},
      {"tremor_mm", tremor.mm},
      {"tremor_deg", tremor.deg},
      {"carry_from_s", carry.from_s},
      {"carry_to_s", carry.to_s},
      {"carry_dx", carry.dx},
      {"carry_dy", carry.dy},
      {"carry_yaw", carry.yaw},
      {"speed_mean_m_s", s.motion_speed.mean},
      {"speed_p99_m_s", s.motion_speed.p99},
      {"rate_mean_rad_s", s.motion_speed.turn_mean},
      {"rate_p99_rad_s", s.motion_speed.turn_p99},
      {"moved_m", Numbers(s.motion.T_map_source.p)},
      {"turned_about_z_rad", LogSO3(s.motion.T_map_source.q).z()},
      {"fit_rms_m", s.motion.fit_rms_m},
      {"fit_rms_deg", s.motion.fit_rms_deg},
  };
}

Json SensorJson(const SimulationSettings& settings, const SimulationSummary& s) {
  return {
      {"threshold", settings.sensor.threshold},
      {"threshold_spread", settings.sensor.threshold_spread},
      {"low_pass_ms", settings.sensor.low_pass_ms},
      {"refractory_ms", settings.sensor.refractory_ms},
      {"noise_hz", settings.sensor.noise_hz},
      {"hot_pixels", settings.sensor.hot_pixels},
      {"bright_grey", settings.sensor.bright_grey},
      {"threshold_drift", settings.sensor.threshold_drift},
      {"leak_hz", settings.sensor.leak_hz},
      {"lens_blur_px", settings.optics.blur_px},
      {"saturation_grey", settings.optics.saturation_grey},
      {"burst_share", settings.readout.burst_share},
      {"readout_hz", settings.readout.rate_hz},
      {"lost", s.events.lost},
  };
}

Json ImuJson(const ImuSettings& settings, const SimulationSummary& s) {
  return {
      {"samples", s.n_imu},
      {"noise_factor", settings.noise_factor},
      {"vibration_accel", settings.vibration_accel},
      {"vibration_gyro", settings.vibration_gyro},
      {"first_gyro_bias", Numbers(s.first_bias.gyro)},
      {"first_accel_bias", Numbers(s.first_bias.accel)},
      {"last_gyro_bias", Numbers(s.last_bias.gyro)},
      {"last_accel_bias", Numbers(s.last_bias.accel)},
  };
}

Json EventsJson(const SimulationSummary& s) {
  return {
      {"total", s.events.total()},
      {"positive", s.events.positive},
      {"negative", s.events.negative},
      {"noise", s.events.noise},
      {"mean_per_s", static_cast<double>(s.events.total()) / s.duration_s},
      {"peak_per_s_over_10ms", s.events.peak_rate},
  };
}

Json ImageJson(const SimulationSettings& settings, const SimulationSummary& s) {
  return {
      {"renders", s.n_renders},          {"max_step_px", settings.max_step_px},
      {"speed_mean_px_s", s.speed.mean}, {"speed_median_px_s", s.speed.median},
      {"speed_p95_px_s", s.speed.p95},   {"speed_max_px_s", s.speed.max},
      {"mean_depth_m", s.mean_depth},
  };
}

Json MapJson(const MapSettings& settings, const SimulationSummary& s) {
  return {
      {"points", s.n_map_points},
      {"views", s.n_map_views},
      {"depth_noise", settings.depth_noise},
      {"edge_noise_px", settings.edge_noise_px},
      {"view_jitter_m", settings.view_jitter_m},
      {"outlier_share", settings.outlier_share},
      {"outlier_m", settings.outlier_m},
      {"voxel_m", settings.voxel_m},
      {"hole_share", settings.holes.share},
      {"hole_m", settings.holes.diameter_m},
  };
}

}  // namespace

void WriteReport(const std::string& path, const SimulationSettings& settings, const SimulationSummary& s) {
  const auto& disturbances = settings.disturbances;
  const Json json = {
      {"name", s.name},
      {"command", settings.command},
      {"profile", settings.profile},
      {"scene_seed", settings.room.seed},
      {"seed", settings.seed},
      {"room", RoomName(settings.room.kind)},
      {"moving_box", disturbances.moving_box ? 1 : 0},
      {"trajectory", TrajectoryJson(settings.trajectory, s)},
      {"sensor", SensorJson(settings, s)},
      {"imu", ImuJson(settings.imu, s)},
      {"events", EventsJson(s)},
      {"image", ImageJson(settings, s)},
      {"map", MapJson(settings.map, s)},
      {"lamp",
       {{"off_s", disturbances.lamp_off_s},
        {"on_s", disturbances.lamp_on_s},
        {"share", disturbances.lamp_share}}},
      {"dark", {{"from_s", disturbances.dark_from_s}, {"to_s", disturbances.dark_to_s}}},
  };
  std::ofstream file(path);
  // A path in the command need not be UTF-8.
  file << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace evit::simulation
