#include "tools/simulation/profile.h"

namespace evit::simulation {
namespace {

void ApplySensor(SimulationSettings* s) {
  s->optics.blur_px = 0.7;
  s->optics.saturation_grey = 235;
  s->sensor.low_pass_ms = 0.5;
  s->sensor.bright_grey = 150;
  s->sensor.threshold = 0.4;
  s->sensor.threshold_spread = 0.2;
  s->sensor.threshold_drift = 0.05;
  s->sensor.leak_hz = 0.05;
  s->sensor.refractory_ms = 0.5;
  s->sensor.noise_hz = 0.1;
  s->sensor.hot_pixels = 30;
  s->readout.burst_share = 0.1;
  s->readout.burst_gap_ms = 0.5;
  s->readout.rate_hz = 30e6;
  s->imu.vibration_accel = 0.1;
  s->imu.vibration_gyro = 0.005;
}

void ApplyCameraMap(SimulationSettings* s) {
  s->map.images.on = true;
  s->map.voxel_m = 0.01;
}

}  // namespace

bool ProfileFromName(const std::string& name, Profile* profile) {
  if (name == "ideal") {
    *profile = Profile::kIdeal;
  } else if (name == "camera-map") {
    *profile = Profile::kCameraMap;
  } else if (name == "sensor") {
    *profile = Profile::kSensor;
  } else if (name == "real") {
    *profile = Profile::kReal;
  } else {
    return false;
  }
  return true;
}

void ApplyProfile(Profile profile, SimulationSettings* settings) {
  if (profile == Profile::kSensor || profile == Profile::kReal) ApplySensor(settings);
  if (profile == Profile::kCameraMap || profile == Profile::kReal) ApplyCameraMap(settings);
}

}  // namespace evit::simulation
