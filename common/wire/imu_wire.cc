#include "common/wire/imu_wire.h"

namespace evit {
namespace {

std::vector<double> Row(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

template <typename Message>
std::vector<ImuSample> Samples(const std::vector<std::int64_t>& times, const Message& m) {
  std::vector<ImuSample> samples;
  samples.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    samples.push_back({times[i], Eigen::Vector3d(m.gyro[i].data()), Eigen::Vector3d(m.accel[i].data())});
  }
  return samples;
}

}  // namespace

imu_batch_t ToMessage(const ImuSample& sample) {
  imu_batch_t m{};
  m.utime = sample.t;
  m.n = 1;
  m.sample_utime = {sample.t};
  m.gyro = {Row(sample.gyro)};
  m.accel = {Row(sample.accel)};
  return m;
}

std::vector<ImuSample> SamplesOf(const imu_batch_t& message) {
  return Samples(message.sample_utime, message);
}

void PutSamples(const std::vector<ImuSample>& samples, keyframe_t* message) {
  message->n_imu = static_cast<std::int32_t>(samples.size());
  message->imu_utime.clear(), message->gyro.clear(), message->accel.clear();
  for (const ImuSample& s : samples) {
    message->imu_utime.push_back(s.t);
    message->gyro.push_back(Row(s.gyro));
    message->accel.push_back(Row(s.accel));
  }
}

std::vector<ImuSample> SamplesOf(const keyframe_t& message) { return Samples(message.imu_utime, message); }

}  // namespace evit
