#pragma once

#include <map>

#include "common/time/utime.h"

namespace evit::formats {

/// From a sensor's clock to its host's, by stamps that the host gave when data arrived: never too early, now
/// and then too late. The smallest offset of each second counts; over more than ten seconds a straight line
/// through them follows the drift of the two clocks.
class ClockFit {
 public:
  void Add(Utime sensor, Utime host);
  /// Call after the last Add and before ToHost.
  void Solve();
  Utime ToHost(Utime sensor) const;

 private:
  std::map<Utime, Utime> offsets_;  // second of the sensor's clock to its smallest offset (host - sensor), us
  Utime origin_ = 0, offset_ = 0;
  double slope_ = 0;
};

}  // namespace evit::formats
