#include "services/window_optimizer/checkpoint.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <limits>

namespace evit {
namespace {

constexpr char kHead[] = "evit-checkpoint-1";

}  // namespace

BodyState Checkpoint::After(Utime dt) const {
  const double s = ToSeconds(dt);
  BodyState later = state;
  later.T_world_body.p += s * state.velocity;
  later.T_world_body.q = (state.T_world_body.q * ExpSO3(s * rate)).normalized();
  return later;
}

bool SaveCheckpoint(const std::string& path, const Checkpoint& c) {
  const std::string part = path + ".part";
  std::ofstream file(part);
  file << kHead << ' ' << c.t << std::setprecision(std::numeric_limits<double>::max_digits10);
  const auto& pose = c.state.T_world_body;
  for (const Eigen::Vector3d& v : {pose.p, c.state.velocity, c.state.bias.gyro, c.state.bias.accel, c.rate}) {
    for (int k = 0; k < 3; ++k) file << ' ' << v[k];
  }
  for (int k = 0; k < 4; ++k) file << ' ' << pose.q.coeffs()[k];
  file << " end\n";
  file.close();
  if (file && std::rename(part.c_str(), path.c_str()) == 0) return true;
  std::remove(part.c_str());
  return false;
}

std::optional<Checkpoint> LoadCheckpoint(const std::string& path) {
  std::ifstream file(path);
  std::string head, end;
  Checkpoint c;
  file >> head >> c.t;
  bool finite = true;
  const auto read = [&](double* value) {
    file >> *value;
    finite = finite && std::isfinite(*value);
  };
  auto& pose = c.state.T_world_body;
  for (Eigen::Vector3d* v : {&pose.p, &c.state.velocity, &c.state.bias.gyro, &c.state.bias.accel, &c.rate}) {
    for (int k = 0; k < 3; ++k) read(&(*v)[k]);
  }
  for (int k = 0; k < 4; ++k) read(&pose.q.coeffs()[k]);
  file >> end;
  if (!file || head != kHead || end != "end" || !finite || std::abs(pose.q.norm() - 1) > 1e-6)
    return std::nullopt;
  return c;
}

}  // namespace evit
