#include "common/tracking/alignment_significance.h"

#include <cmath>
#include <vector>

#include "common/tracking/batch_samples.h"
#include "common/tracking/image_patches.h"

namespace evit {
namespace {

constexpr float kBeside = 10;       // pixels
constexpr float kRounding = 0.01F;  // grey levels: of a field without events, whose values are all the same

class PatchSums {
 public:
  explicit PatchSums(const Camera& camera) : patches_(camera), sums_(patches_.size()) {}

  void Add(float u, float v, double value) { sums_[patches_.At(u, v)] += value; }
  double Significance() const {
    double sum = 0, squares = 0;
    for (const double s : sums_) sum += s, squares += s * s;
    return squares > 0 ? sum / std::sqrt(squares) : 0;
  }

 private:
  ImagePatches patches_;
  std::vector<double> sums_;
};

// The points of a pose, and how much better each lies there than beside.
class Depths {
 public:
  Depths(const AlignmentSettings& settings, const SurfaceField& field, const AlignmentPoints& points,
         const SE3& T_map_body)
      : right_(static_cast<float>(settings.camera().width - 1) - kBeside),
        bottom_(static_cast<float>(settings.camera().height - 1) - kBeside),
        samples_(
            SampleBeside(BatchAlignment(settings, field, 0, points, T_map_body), points.local(), kBeside)) {}

  const BesideSamples& samples() const { return samples_; }
  bool inside(std::size_t k) const { return samples_.inside[k] != 0; }
  float u(std::size_t k) const { return samples_.u[k]; }  // pixels
  float v(std::size_t k) const { return samples_.v[k]; }
  // Grey levels; 0 where it is not well inside the image.
  float At(std::size_t k) const {
    const bool well = inside(k) && u(k) >= kBeside && v(k) >= kBeside && u(k) <= right_ && v(k) <= bottom_;
    const float depth = samples_.beside[k] - samples_.value[k];
    return well && std::abs(depth) > kRounding ? depth : 0;
  }

 private:
  float right_, bottom_;  // pixels: of what is well inside
  BesideSamples samples_;
};

double SignificanceOf(const Depths& depths, const Camera& camera, std::size_t n) {
  PatchSums sums(camera);
  for (std::size_t k = 0; k < n; ++k) {
    if (depths.inside(k)) sums.Add(depths.u(k), depths.v(k), depths.At(k));
  }
  return sums.Significance();
}

}  // namespace

double AlignmentSignificance(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& T_map_body) {
  return SignificanceOf(Depths(settings, field, points, T_map_body), settings.camera(), points.size());
}

AlignmentVerdict JudgeAlignment(const AlignmentSettings& settings, const SurfaceField& field,
                                const AlignmentPoints& points, const SE3& T_map_body) {
  const Depths depths(settings, field, points, T_map_body);
  return {QualityOf(depths.samples(), points.size()),
          SignificanceOf(depths, settings.camera(), points.size())};
}

double SignificanceOver(const AlignmentSettings& settings, const SurfaceField& field,
                        const AlignmentPoints& points, const SE3& a, const SE3& b) {
  const Depths at_a(settings, field, points, a), at_b(settings, field, points, b);
  PatchSums sums(settings.camera());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (at_a.inside(k)) sums.Add(at_a.u(k), at_a.v(k), at_a.At(k) - at_b.At(k));
  }
  return sums.Significance();
}

}  // namespace evit
