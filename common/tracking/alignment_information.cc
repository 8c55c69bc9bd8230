#include "common/tracking/alignment_information.h"

namespace evit {

Matrix6d AlignmentInformation(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body) {
  return EvaluateAlignmentExactly(settings, field, points, T_map_body).hessian;
}

}  // namespace evit
