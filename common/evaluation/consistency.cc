#include "common/evaluation/consistency.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <numeric>

namespace evit {
namespace {

constexpr double kBound3 = 7.814727903251179, kBound6 = 12.591587243743977;  // chi-square, 95 %

Nees Summarize(int dof, std::vector<double> values) {
  Nees nees;
  nees.dof = dof;
  nees.n = static_cast<int>(values.size());
  if (values.empty()) return nees;
  const double n = nees.n, bound = dof == 3 ? kBound3 : kBound6;
  nees.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  nees.share_in_95 =
      static_cast<double>(std::count_if(values.begin(), values.end(), [&](double v) { return v < bound; })) /
      n;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  nees.median = *middle;
  if (values.size() % 2 == 0) nees.median = 0.5 * (nees.median + *std::max_element(values.begin(), middle));
  return nees;
}

}  // namespace

Consistency ConsistencyOf(const Trajectory& truth, const Trajectory& estimate,
                          const Covariances& covariances) {
  Consistency out;
  std::vector<double> position, orientation, pose;
  auto of = covariances.begin();
  for (const StampedPose& s : estimate) {
    SE3 at;
    if (!PoseAt(truth, s.t, &at)) continue;
    PoseError row;
    row.t = s.t;
    row.error << at.p - s.pose.p, LogSO3(s.pose.q.conjugate() * at.q);
    row.sigma.setZero();
    while (of != covariances.end() && of->t < s.t) ++of;
    const bool given = of != covariances.end() && of->t == s.t;
    const Eigen::LLT<Matrix6d> llt(given ? of->covariance : Matrix6d(Matrix6d::Zero()));
    if (!given || llt.info() != Eigen::Success || !(llt.rcond() > 0)) {
      ++out.without_covariance;
    } else {
      const Matrix6d& P = of->covariance;
      const Eigen::Vector3d p = row.error.head<3>(), r = row.error.tail<3>();
      row.sigma = P.diagonal().cwiseSqrt();
      position.push_back(p.dot(P.topLeftCorner<3, 3>().llt().solve(p)));
      orientation.push_back(r.dot(P.bottomRightCorner<3, 3>().llt().solve(r)));
      pose.push_back(row.error.dot(llt.solve(row.error)));
    }
    out.errors.push_back(row);
  }
  out.position = Summarize(3, std::move(position));
  out.orientation = Summarize(3, std::move(orientation));
  out.pose = Summarize(6, std::move(pose));
  return out;
}

std::string ConsistencyText(const Consistency& c) {
  if (c.pose.n == 0) return "consistency: no pose has both truth and a covariance";
  std::string text = "consistency, NEES/dof (1: consistent):";
  for (const auto& [name, nees] : {std::pair("position", &c.position),
                                   std::pair("orientation", &c.orientation), std::pair("pose", &c.pose)}) {
    char part[120];
    std::snprintf(part, sizeof part, "%s %s %.2f (median %.2f, %.0f %% within the 95 %% bound)",
                  nees == &c.position ? "" : ",", name, nees->mean_per_dof(), nees->median / nees->dof,
                  100 * nees->share_in_95);
    text += part;
  }
  return text;
}

}  // namespace evit
