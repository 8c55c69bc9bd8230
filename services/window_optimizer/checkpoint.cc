#include "services/window_optimizer/checkpoint.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

using StateVector = Eigen::Matrix<double, 16, 1>;

StateVector ToVector(const BodyState& state) {
  StateVector v;
  v << state.T_map_body.p, state.T_map_body.q.coeffs(), state.velocity, state.bias.gyro, state.bias.accel;
  return v;
}

BodyState FromVector(const StateVector& v) {
  BodyState state;
  state.T_map_body = {Eigen::Quaterniond(v[6], v[3], v[4], v[5]), v.head<3>()};
  state.velocity = v.segment<3>(7);
  state.bias = {v.segment<3>(10), v.segment<3>(13)};
  return state;
}

}  // namespace

BodyState Checkpoint::After(Utime dt) const {
  const double s = ToSeconds(dt);
  BodyState later = state;
  later.T_map_body.p += s * state.velocity;
  later.T_map_body.q = (state.T_map_body.q * ExpSO3(s * rate)).normalized();
  return later;
}

void CheckpointFile::Store(const Checkpoint& c) {
  Record r{};
  r.t = c.t;
  r.keyframe_epoch = c.keyframe_epoch;
  r.keyframe_seq = c.keyframe_seq;
  r.image_speed = c.image_speed;
  Eigen::Map<StateVector>(r.state) = ToVector(c.state);
  Eigen::Map<Eigen::Vector3d>(r.rate) = c.rate;
  Eigen::Map<Matrix15d>(r.information) = c.information;
  file_.Store(r);
}

std::optional<Checkpoint> CheckpointFile::Load() const {
  const std::optional<Record> r = file_.Load();
  if (!r) return std::nullopt;
  Checkpoint c;
  c.t = r->t;
  c.keyframe_epoch = r->keyframe_epoch;
  c.keyframe_seq = r->keyframe_seq;
  c.image_speed = r->image_speed;
  const StateVector state = Eigen::Map<const StateVector>(r->state);
  c.state = FromVector(state);
  c.rate = Eigen::Map<const Eigen::Vector3d>(r->rate);
  c.information = Eigen::Map<const Matrix15d>(r->information);
  const bool sane = state.allFinite() && c.rate.allFinite() && c.information.allFinite() &&
                    std::isfinite(c.image_speed) && std::abs(c.state.T_map_body.q.norm() - 1) < 1e-6;
  return sane ? std::optional<Checkpoint>(c) : std::nullopt;
}

}  // namespace evit
