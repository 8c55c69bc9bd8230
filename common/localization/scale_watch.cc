#include "common/localization/scale_watch.h"

namespace evit {
namespace {

constexpr Utime kStep = 50'000;         // us: between poses
constexpr Utime kEvery = 250'000;       // us: between fits
constexpr Utime kLongest = 10'000'000;  // us
constexpr Utime kSpan = 4'000'000;      // us of poses in a fit: longer, and biases and tilt are not constant
constexpr int kSure = 2;                // fits in a row
constexpr double kWellKnown = 0.06;     // sigma of the scale from which nothing is left to watch

}  // namespace

void ScaleWatch::Begin() {
  steps_.clear();
  imu_.clear();
  begun_ = fitted_ = 0;
  disagreed_ = 0;
}

ScaleWatch::Verdict ScaleWatch::Add(Utime t, const SE3& T_map_body, const std::vector<ImuSample>& imu) {
  if (begun_ == 0) begun_ = fitted_ = t;
  if (t - begun_ > kLongest) return Verdict::kAgrees;
  for (const ImuSample& sample : imu)
    if (imu_.empty() || sample.t > imu_.back().t) imu_.push_back(sample);
  if (!steps_.empty() && t - steps_.back().t < kStep) return Verdict::kOpen;
  steps_.push_back({t, T_map_body, 0});
  if (t - fitted_ < kEvery) return Verdict::kOpen;
  fitted_ = t;
  auto first = steps_.begin();
  while (t - first->t > kSpan) ++first;
  steps_.erase(steps_.begin(), first);
  auto sample = imu_.begin();
  while (sample != imu_.end() && sample->t < steps_.front().t) ++sample;
  imu_.erase(imu_.begin(), sample);
  const std::optional<MotionFit> fit = FitMotion(steps_, imu_, gravity_);
  if (!fit) return Verdict::kOpen;
  fit_ = *fit;
  disagreed_ = fit_.Disagrees() ? disagreed_ + 1 : 0;
  if (disagreed_ >= kSure) return Verdict::kDisagrees;
  return disagreed_ == 0 && fit_.scale_sigma < kWellKnown ? Verdict::kAgrees : Verdict::kOpen;
}

}  // namespace evit
