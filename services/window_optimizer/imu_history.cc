#include "services/window_optimizer/imu_history.h"

#include <algorithm>

namespace evit {

bool ImuHistory::Add(const ImuSample& sample) {
  constexpr Utime kJump = kMicrosPerSecond;
  // A clock that jumps: what came before does not belong to what comes now.
  if (!samples_.empty() && (sample.t < samples_.back().t - kJump || sample.t > samples_.back().t + kSpan))
    Clear();
  if (!samples_.empty() && sample.t <= samples_.back().t) return false;
  samples_.push_back(sample);
  while (samples_.back().t - samples_.front().t > kSpan) samples_.pop_front();
  return true;
}

std::vector<ImuSample> ImuHistory::Between(Utime begin, Utime end) const {
  if (samples_.empty() || begin < samples_.front().t || end > samples_.back().t || begin >= end) return {};
  const auto after = [](Utime t, const ImuSample& s) { return t < s.t; };
  auto it =
      std::upper_bound(samples_.begin(), samples_.end(), begin, after);  // first sample later than begin
  std::vector<ImuSample> out;
  const ImuSample& before = *(it - 1);
  out.push_back(before.t == begin ? before : InterpolateImu(before, *it, begin));
  for (; it != samples_.end() && it->t < end; ++it) out.push_back(*it);
  out.push_back(it->t == end ? *it : InterpolateImu(*(it - 1), *it, end));
  return out;
}

Utime ImuHistory::LongestGap(const std::vector<ImuSample>& samples) {
  Utime gap = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) gap = std::max(gap, samples[k].t - samples[k - 1].t);
  return gap;
}

}  // namespace evit
