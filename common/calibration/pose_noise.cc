#include "common/calibration/pose_noise.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

double MedianAbs(std::vector<double> values) {
  if (values.empty()) return 0;
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// 1 + 2 (sum of the autocorrelation), up to where it has died away: so many values are worth one.
double CorrelationTime(const std::vector<std::vector<double>>& axes) {
  double power = 0;
  for (const auto& axis : axes) {
    for (const double v : axis) power += v * v;
  }
  double time = 1;
  const std::size_t n = axes[0].size();
  for (std::size_t lag = 1; power > 0 && lag < n / 5; ++lag) {
    double sum = 0;
    for (const auto& axis : axes) {
      for (std::size_t k = lag; k < n; ++k) sum += axis[k] * axis[k - lag];
    }
    if (sum < 0.05 * power) break;
    time += 2 * sum / power;
  }
  return time;
}

// The same from the spread of means over pieces, compared with that of white noise. Errors that wander slowly
// and are small beside the white ones hardly show in the autocorrelation, and yet they are what remains in a
// mean.
double BlockTime(const std::vector<std::vector<double>>& axes) {
  double power = 0, most = 1;
  const std::size_t n = axes[0].size();
  for (const auto& axis : axes) {
    for (const double v : axis) power += v * v / static_cast<double>(n);
  }
  constexpr std::size_t kFewestBlocks = 8;
  for (std::size_t length = 2; power > 0 && length <= n / kFewestBlocks; length *= 2) {
    const std::size_t blocks = n / length;
    double of_means = 0;
    for (const auto& axis : axes) {
      for (std::size_t b = 0; b < blocks; ++b) {
        double sum = 0;
        for (std::size_t k = b * length; k < (b + 1) * length; ++k) sum += axis[k];
        of_means += std::pow(sum / static_cast<double>(length), 2) / static_cast<double>(blocks);
      }
    }
    most = std::max(most, static_cast<double>(length) * of_means / power);
  }
  return most;
}

double WorthOne(const std::vector<std::vector<double>>& axes) {
  return std::max(CorrelationTime(axes), BlockTime(axes));
}

}  // namespace

PoseNoise MeasurePoseNoise(const std::vector<Eigen::Matrix<double, 6, 1>>& residuals) {
  std::vector<std::vector<double>> axes(6);
  for (const Eigen::Matrix<double, 6, 1>& r : residuals) {
    for (int i = 0; i < 6; ++i) axes[i].push_back(r[i]);
  }
  const auto sigma = [&](int first) {
    std::vector<double> all;
    for (int i = first; i < first + 3; ++i) all.insert(all.end(), axes[i].begin(), axes[i].end());
    return 1.4826 * MedianAbs(all);
  };
  PoseNoise noise;
  noise.position = std::max(sigma(0), 1e-6);
  noise.rotation = std::max(sigma(3), 1e-6);
  // What is far off would be all of the correlation.
  for (int i = 0; i < 6; ++i) {
    const double limit = 5 * (i < 3 ? noise.position : noise.rotation);
    for (double& v : axes[i]) v = std::clamp(v, -limit, limit);
  }
  noise.position_correlation = WorthOne({axes[0], axes[1], axes[2]});
  noise.rotation_correlation = WorthOne({axes[3], axes[4], axes[5]});
  return noise;
}

}  // namespace evit
