#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/localization/upright.h"

namespace evit {

/// Which vertical to search the map with next. A search finds the place where its vertical is right to some 8
/// degrees; in fast motion nobody knows it so well. So each search takes the vertical around which lies most
/// of the probability that no search before has tried. A search may fail for other reasons too, so what was
/// tried becomes less likely, not impossible, and counts less as it grows old.
class VerticalSearch {
 public:
  void Clear() { tried_.clear(); }
  /// `R_now_before`: how the body has turned since the last call (gyro). `seconds`: since then.
  Eigen::Vector3d Next(const Upright& upright, const Eigen::Quaterniond& R_now_before, double seconds);

 private:
  struct Tried {
    Eigen::Vector3d up;  // body frame, at the last call
    double age;          // s
  };
  std::vector<Tried> tried_;
};

}  // namespace evit
