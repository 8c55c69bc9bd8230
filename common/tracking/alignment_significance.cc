#include "common/tracking/alignment_significance.h"

#include <cmath>
#include <vector>

#include "common/tracking/image_patches.h"

namespace evit {
namespace {

constexpr double kBeside = 10;      // pixels
constexpr double kRounding = 0.01;  // grey levels: of a field without events, whose values are all the same

class PatchSums {
 public:
  explicit PatchSums(const Camera& camera) : patches_(camera), sums_(patches_.size()) {}

  void Add(const Eigen::Vector2d& at, double value) { sums_[patches_.At(at)] += value; }
  double Significance() const {
    double sum = 0, squares = 0;
    for (const double s : sums_) sum += s, squares += s * s;
    return squares > 0 ? sum / std::sqrt(squares) : 0;
  }

 private:
  ImagePatches patches_;
  std::vector<double> sums_;
};

// How much better a point lies there than beside, grey levels; 0 where it is not well inside the image.
double Depth(const SurfaceField& field, const Camera& camera, const Eigen::Vector2d& at) {
  if (!camera.Contains(at, kBeside)) return 0;
  const auto value = [&](double dx, double dy) {
    return static_cast<double>(field.At(0, at.x() + dx, at.y() + dy).value);
  };
  const double depth =
      0.25 * (value(kBeside, 0) + value(-kBeside, 0) + value(0, kBeside) + value(0, -kBeside)) - value(0, 0);
  return std::abs(depth) > kRounding ? depth : 0;
}

}  // namespace

double AlignmentSignificance(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& T_map_body) {
  const Camera& camera = settings.camera();
  const SE3 T_camera_map = settings.T_camera_body * T_map_body.Inverse();
  PatchSums sums(camera);
  for (std::size_t k = 0; k < points.size(); ++k) {
    Eigen::Vector2d at;
    if (camera.Project(T_camera_map * points.At(k), &at) && camera.Contains(at, kBeside))
      sums.Add(at, Depth(field, camera, at));
  }
  return sums.Significance();
}

double SignificanceOver(const AlignmentSettings& settings, const SurfaceField& field,
                        const AlignmentPoints& points, const SE3& a, const SE3& b) {
  const Camera& camera = settings.camera();
  const SE3 T_a = settings.T_camera_body * a.Inverse(), T_b = settings.T_camera_body * b.Inverse();
  PatchSums sums(camera);
  for (std::size_t k = 0; k < points.size(); ++k) {
    Eigen::Vector2d at_a, at_b;
    if (!camera.Project(T_a * points.At(k), &at_a) || !camera.Contains(at_a)) continue;
    const double there = camera.Project(T_b * points.At(k), &at_b) ? Depth(field, camera, at_b) : 0;
    sums.Add(at_a, Depth(field, camera, at_a) - there);
  }
  return sums.Significance();
}

}  // namespace evit
