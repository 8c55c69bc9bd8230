#include "common/imu/steadiness.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr Utime kKept = 1'000'000, kShortest = 250'000;  // us
constexpr Utime kBlock = 50'000;                         // us: means over so long tell motion from vibration
// What a mean over a block may be off the mean of all of them: within a block it turns the body by half a
// milliradian, or moves it by an eighth of a millimetre.
constexpr double kMaxRate = 0.01;  // rad/s
constexpr double kMaxForce = 0.1;  // m/s^2
constexpr double kMostNoise = 2;   // times these limits: a rig file with large densities must not hide motion

// `limit` and three standard deviations of a block's mean.
double Limit(double limit, double density) {
  return limit + std::min(3 * density / std::sqrt(ToSeconds(kBlock)), kMostNoise * limit);
}

}  // namespace

void Steadiness::Add(const std::vector<ImuSample>& samples) {
  for (const ImuSample& sample : samples) {
    if (samples_.empty() || sample.t > samples_.back().t) samples_.push_back(sample);
  }
  while (!samples_.empty() && samples_.front().t < samples_.back().t - kKept) samples_.pop_front();
}

std::optional<ImuSample> Steadiness::SteadyReading(Utime begin) const {
  if (samples_.empty()) return std::nullopt;
  const Utime end = samples_.back().t, from = std::min(begin, end - kShortest);
  if (samples_.front().t > from) return std::nullopt;
  struct Mean {
    ImuSample reading;
    int n = 0;
    void Add(const ImuSample& sample) {
      ++n;
      reading.gyro += (sample.gyro - reading.gyro) / n;
      reading.accel += (sample.accel - reading.accel) / n;
    }
  };
  std::vector<Mean> blocks(static_cast<std::size_t>((end - from) / kBlock) + 1);  // newest first
  Mean all;
  for (const ImuSample& sample : samples_) {
    if (sample.t < from) continue;
    blocks[static_cast<std::size_t>((end - sample.t) / kBlock)].Add(sample);
    all.Add(sample);
  }
  const double max_rate = Limit(kMaxRate, noise_.gyro_density);
  const double max_force = Limit(kMaxForce, noise_.accel_density);
  for (const Mean& block : blocks) {
    if (2 * block.n * static_cast<int>(blocks.size()) < all.n) {
      // The oldest may be cut off: with few samples it would say little but noise. A hole could hide motion.
      if (&block != &blocks.back()) return std::nullopt;
      continue;
    }
    if ((block.reading.gyro - all.reading.gyro).cwiseAbs().maxCoeff() > max_rate ||
        (block.reading.accel - all.reading.accel).cwiseAbs().maxCoeff() > max_force) {
      return std::nullopt;
    }
  }
  all.reading.t = end;
  return all.reading;
}

}  // namespace evit
