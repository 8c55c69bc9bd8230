#include "tools/simulation/report.h"

#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "common/geometry/so3.h"

namespace evit::simulation {
namespace {

// Just enough JSON for a flat report with sections.
class Json {
 public:
  Json& Open(const std::string& key) {
    Key(key);
    text_ << "{";
    first_ = true;
    ++depth_;
    return *this;
  }
  Json& Close() {
    --depth_;
    first_ = false;
    text_ << '\n' << Indent() << '}';
    return *this;
  }
  Json& Number(const std::string& key, double value) {
    Key(key);
    text_ << std::setprecision(10) << value;
    return *this;
  }
  Json& Text(const std::string& key, const std::string& value) {
    Key(key);
    Quote(value);
    return *this;
  }
  Json& Vector(const std::string& key, const Eigen::Vector3d& v) {
    Key(key);
    text_ << '[' << v.x() << ", " << v.y() << ", " << v.z() << ']';
    return *this;
  }
  std::string Take() { return text_.str() + "\n"; }

 private:
  void Key(const std::string& key) {
    if (depth_ == 0) return;
    text_ << (first_ ? "\n" : ",\n") << Indent();
    first_ = false;
    Quote(key);
    text_ << ": ";
  }
  std::string Indent() const { return std::string(static_cast<std::size_t>(depth_) * 2, ' '); }
  void Quote(const std::string& value) {
    text_ << '"';
    for (const char c : value) {
      if (c == '"' || c == '\\') {
        text_ << '\\' << c;
      } else {
        text_ << (static_cast<unsigned char>(c) < 0x20 ? ' ' : c);
      }
    }
    text_ << '"';
  }

  std::ostringstream text_;
  bool first_ = true;
  int depth_ = 0;
};

}  // namespace

void WriteReport(const std::string& path, const SimulationSettings& settings, const SimulationSummary& s) {
  Json json;
  json.Open("").Text("name", s.name).Text("command", settings.command).Text("profile", settings.profile);
  json.Number("scene_seed", static_cast<double>(settings.room.seed))
      .Number("seed", static_cast<double>(settings.seed));
  json.Text("room", RoomName(settings.room.kind))
      .Number("moving_box", settings.disturbances.moving_box ? 1 : 0);
  json.Open("trajectory").Text("source", settings.trajectory.source).Text("note", s.motion.note);
  json.Number("begin_us", static_cast<double>(s.motion.begin)).Number("duration_s", s.duration_s);
  json.Number("knot_ms", settings.trajectory.knot_ms).Number("play_speed", settings.trajectory.play_speed);
  json.Number("variant", static_cast<double>(settings.trajectory.variant));
  const Tremor& tremor = settings.trajectory.tremor;
  json.Number("tremor_hz", tremor.hz).Number("tremor_mm", tremor.mm).Number("tremor_deg", tremor.deg);
  const Carry& carry = settings.trajectory.carry;
  json.Number("carry_from_s", carry.from_s).Number("carry_to_s", carry.to_s);
  json.Number("carry_dx", carry.dx).Number("carry_dy", carry.dy).Number("carry_yaw", carry.yaw);
  json.Number("speed_mean_m_s", s.motion_speed.mean).Number("speed_p99_m_s", s.motion_speed.p99);
  json.Number("rate_mean_rad_s", s.motion_speed.turn_mean).Number("rate_p99_rad_s", s.motion_speed.turn_p99);
  json.Vector("moved_m", s.motion.T_map_source.p)
      .Number("turned_about_z_rad", LogSO3(s.motion.T_map_source.q).z());
  json.Number("fit_rms_m", s.motion.fit_rms_m).Number("fit_rms_deg", s.motion.fit_rms_deg).Close();
  json.Open("sensor").Number("threshold", settings.sensor.threshold);
  json.Number("threshold_spread", settings.sensor.threshold_spread);
  json.Number("low_pass_ms", settings.sensor.low_pass_ms)
      .Number("refractory_ms", settings.sensor.refractory_ms);
  json.Number("noise_hz", settings.sensor.noise_hz).Number("hot_pixels", settings.sensor.hot_pixels);
  json.Number("bright_grey", settings.sensor.bright_grey)
      .Number("threshold_drift", settings.sensor.threshold_drift);
  json.Number("leak_hz", settings.sensor.leak_hz).Number("lens_blur_px", settings.optics.blur_px);
  json.Number("saturation_grey", settings.optics.saturation_grey)
      .Number("burst_share", settings.readout.burst_share);
  json.Number("readout_hz", settings.readout.rate_hz)
      .Number("lost", static_cast<double>(s.events.lost))
      .Close();
  json.Open("imu")
      .Number("samples", static_cast<double>(s.n_imu))
      .Number("noise_factor", settings.imu.noise_factor)
      .Number("vibration_accel", settings.imu.vibration_accel)
      .Number("vibration_gyro", settings.imu.vibration_gyro);
  json.Vector("first_gyro_bias", s.first_bias.gyro).Vector("first_accel_bias", s.first_bias.accel);
  json.Vector("last_gyro_bias", s.last_bias.gyro).Vector("last_accel_bias", s.last_bias.accel).Close();
  json.Open("events").Number("total", static_cast<double>(s.events.total()));
  json.Number("positive", static_cast<double>(s.events.positive));
  json.Number("negative", static_cast<double>(s.events.negative));
  json.Number("noise", static_cast<double>(s.events.noise));
  json.Number("mean_per_s", static_cast<double>(s.events.total()) / s.duration_s);
  json.Number("peak_per_s_over_10ms", s.events.peak_rate).Close();
  json.Open("image")
      .Number("renders", static_cast<double>(s.n_renders))
      .Number("max_step_px", settings.max_step_px);
  json.Number("speed_mean_px_s", s.speed.mean).Number("speed_median_px_s", s.speed.median);
  json.Number("speed_p95_px_s", s.speed.p95).Number("speed_max_px_s", s.speed.max);
  json.Number("mean_depth_m", s.mean_depth).Close();
  json.Open("map").Number("points", static_cast<double>(s.n_map_points)).Number("views", s.n_map_views);
  json.Number("depth_noise", settings.map.depth_noise).Number("edge_noise_px", settings.map.edge_noise_px);
  json.Number("view_jitter_m", settings.map.view_jitter_m)
      .Number("outlier_share", settings.map.outlier_share);
  json.Number("outlier_m", settings.map.outlier_m).Number("voxel_m", settings.map.voxel_m);
  json.Number("hole_share", settings.map.holes.share).Number("hole_m", settings.map.holes.diameter_m).Close();
  json.Open("lamp")
      .Number("off_s", settings.disturbances.lamp_off_s)
      .Number("on_s", settings.disturbances.lamp_on_s);
  json.Number("share", settings.disturbances.lamp_share).Close();
  json.Open("dark")
      .Number("from_s", settings.disturbances.dark_from_s)
      .Number("to_s", settings.disturbances.dark_to_s)
      .Close();
  json.Close();
  std::ofstream file(path);
  file << json.Take();
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace evit::simulation
