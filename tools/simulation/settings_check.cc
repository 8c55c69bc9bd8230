#include "tools/simulation/settings_check.h"

#include <stdexcept>
#include <string>

namespace evit::simulation {

void CheckSettings(const SimulationSettings& s, const Rig& rig) {
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

}  // namespace evit::simulation
