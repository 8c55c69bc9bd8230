#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "common/tracking/event_alignment.h"

/// The residual of the tracker, written as in the paper: one point at a time, in double precision. To be
/// read, and for tests to compare the fast lanes with (batch_alignment.h, kernel_lanes.h, surface_lanes.h).
namespace evit {

/// Every robust kernel, by name: what the tests run on.
struct NamedKernel {
  RobustKernel::Kind kind;
  const char* name;
};
constexpr NamedKernel kRobustKernels[] = {{RobustKernel::Kind::kHuber, "Huber"},
                                          {RobustKernel::Kind::kCauchy, "Cauchy"},
                                          {RobustKernel::Kind::kGemanMcClure, "GemanMcClure"}};

/// rho(s) and rho'(s) of a squared residual s.
struct KernelValue {
  double rho, slope;
};
KernelValue ReferenceKernel(const RobustKernel& kernel, double s);

/// The event alignment term, paper Eq. (3). `surface`: CV_8UC1, a negated time surface (Sec. III-B.2) that is
/// 2^level times smaller than the image; `points`: map frame, m.
AlignmentTerm ReferenceAlignment(const AlignmentSettings& settings, const cv::Mat& surface, int level,
                                 const std::vector<Eigen::Vector3d>& points, const SE3& T_map_body);

}  // namespace evit
