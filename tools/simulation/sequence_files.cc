#include "tools/simulation/sequence_files.h"

#include <cstdio>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "common/evaluation/trajectory.h"

namespace evit::simulation {
namespace {

std::string Stamp(Utime t) {
  char text[40];
  std::snprintf(text, sizeof(text), "%lld.%06lld", static_cast<long long>(t / kMicrosPerSecond),
                static_cast<long long>(t % kMicrosPerSecond));
  return text;
}

void WriteFile(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace

void WriteImuFile(const std::string& path, const SimulatedImu& imu) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(9);
  text << "# IMU readings (simulated)\n# rad/s, m/s^2; the orientation columns are not simulated\n"
       << "# timestamp gx gy gz ax ay az qx qy qz qw\n";
  for (const ImuSample& s : imu.samples) {
    text << Stamp(s.t);
    for (int i = 0; i < 3; ++i) text << ' ' << s.gyro[i];
    for (int i = 0; i < 3; ++i) text << ' ' << s.accel[i];
    text << " 0 0 0 1\n";
  }
  WriteFile(path, text.str());
}

void WriteGroundTruthFile(const std::string& path, const std::string& name, const Motion& motion,
                          const Rig& rig) {
  std::ostringstream text;
  text << "# ground truth for " << name << "1.synced (simulated; marker body in the map frame, z up)\n"
       << "# timestamp tx ty tz qx qy qz qw\n";
  const SE3 T_body_marker = rig.T_marker_body.Inverse();
  for (int k = 0;; ++k) {
    const Utime t = motion.begin + k * kMicrosPerSecond / 120;
    if (t > motion.end) break;
    text << TumLine({t, motion.spline.Pose(t) * T_body_marker}) << '\n';
  }
  WriteFile(path, text.str());
}

void WriteTruth(const std::string& path, const Motion& motion, const SimulatedImu& imu) {
  Trajectory truth;
  for (const ImuSample& sample : imu.samples) truth.push_back({sample.t, motion.spline.Pose(sample.t)});
  WriteTum(path, truth);
}

}  // namespace evit::simulation
