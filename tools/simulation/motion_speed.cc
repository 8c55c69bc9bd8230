#include "tools/simulation/motion_speed.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace evit::simulation {

MotionSpeed MeasureMotionSpeed(const Motion& motion, const Rig& rig) {
  std::vector<double> speeds, rates;
  for (Utime t = motion.begin; t <= motion.end; t += 5000) {
    const PoseSpline::Sample state = motion.spline.Evaluate(t);
    const Eigen::Vector3d arm = rig.T_body_camera.p;
    speeds.push_back((state.velocity + state.pose.q * state.rate.cross(arm)).norm());
    rates.push_back(state.rate.norm());
  }
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  const auto p99 = [](std::vector<double>* v) {
    const auto at = v->begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(v->size()));
    std::nth_element(v->begin(), at, v->end());
    return *at;
  };
  return {mean(speeds), p99(&speeds), mean(rates), p99(&rates)};
}

}  // namespace evit::simulation
