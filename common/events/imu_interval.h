#pragma once

#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// The IMU samples from one keyframe to the next. Stamps of keyframes may lie between samples: both ends are
/// interpolated where needed.
class ImuInterval {
 public:
  bool begun() const { return !samples_.empty(); }
  /// Requires begun().
  Utime begin() const { return samples_.front().t; }
  /// Samples since begin(), it included.
  std::size_t size() const { return samples_.size(); }
  /// The newest raw sample. Requires begun().
  const ImuSample& newest() const { return newest_; }

  /// Begins at `sample`, whatever was before.
  void Begin(const ImuSample& sample);
  /// Each later than newest(). Requires begun().
  void Add(const ImuSample& sample);
  void Clear() { samples_.clear(); }

  struct Closed {
    std::vector<ImuSample> samples;  // from begin() to the stamp
    Utime gap;                       // us: longest distance between two raw samples
  };
  /// Ends at `stamp`, in (newest().t, next.t], where the next interval begins. Requires begun().
  Closed CloseAt(Utime stamp, const ImuSample& next);

 private:
  std::vector<ImuSample> samples_;
  ImuSample newest_;
  Utime gap_ = 0;
};

}  // namespace evit
