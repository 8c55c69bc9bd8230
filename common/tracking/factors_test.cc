// Every term of the objective against numeric derivatives: at the origin and off it, at small and at large
// rotations.
#include <gtest/gtest.h>

#include <random>

#include "common/tracking/ceres_factors.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

BodyState Moved(const BodyState& s, const Vector15d& d) {
  BodyState out = s;
  out.T_map_body = s.T_map_body.Plus(d.head<6>());
  out.velocity += d.segment<3>(6);
  out.bias.gyro += d.segment<3>(9);
  out.bias.accel += d.segment<3>(12);
  return out;
}

TEST(EventAlignmentFactor, IsTheRobustSumForCeres) {
  const AlignmentSettings settings = synthetic::Alignment();
  const auto points = synthetic::RoomPoints();
  const SurfaceField field(synthetic::DrawSurface(settings, points, SE3()), 1);
  BodyState state;
  state.T_map_body = SE3(ExpSO3({0.01, 0, -0.005}), {0.01, 0.02, 0});
  const StateBlocks blocks = ToBlocks(state);
  const AlignmentPoints local(points);
  const EventAlignmentFactor factor(&settings, &field, 0, &local);
  const double* parameters[] = {blocks.pose.data()};
  Eigen::Matrix<double, 7, 1> r, value_only;
  Eigen::Matrix<double, 7, 7, Eigen::RowMajor> J;
  double* jacobians[] = {J.data()};
  ASSERT_TRUE(factor.Evaluate(parameters, r.data(), jacobians));
  ASSERT_TRUE(factor.Evaluate(parameters, value_only.data(), nullptr));
  const AlignmentTerm term = EvaluateAlignment(settings, field, 0, points, state.T_map_body, true);
  EXPECT_NEAR(0.5 * r.squaredNorm(), term.cost, 1e-9 * term.cost);
  EXPECT_NEAR(0.5 * value_only.squaredNorm(), term.cost, 1e-9 * term.cost);
  const Eigen::Matrix<double, 7, 6> J6 = J.leftCols<6>();
  EXPECT_LT((J6.transpose() * J6 - term.hessian).norm(), 1e-9 * term.hessian.norm());
  EXPECT_LT((J6.transpose() * r - term.gradient).norm(), 1e-9 * term.gradient.norm());
}

TEST(ImuTerm, JacobiansMatchNumericDerivatives) {
  std::mt19937 rng(7);
  std::normal_distribution<double> n;
  const auto random3 = [&](double s) -> Eigen::Vector3d {
    return s * Eigen::Vector3d(n(rng), n(rng), n(rng));
  };
  const synthetic::Motion motion;
  const ImuNoise noise{7e-4, 1.3e-3, 7e-6, 6e-5};
  for (int trial = 0; trial < 20; ++trial) {
    const Preintegration pre(motion.Samples(100'000, 150'000, {}), {random3(0.01), random3(0.1)}, noise);
    const ImuTerm term(&pre, 9.81, 1.0);
    BodyState i, j;
    i.T_map_body = {ExpSO3(random3(trial < 10 ? 0.1 : 1.2)), random3(trial < 10 ? 0.1 : 50)};
    j.T_map_body = {(i.T_map_body.q * ExpSO3(random3(0.2))).normalized(), i.T_map_body.p + random3(0.1)};
    i.velocity = random3(1), j.velocity = random3(1);
    i.bias = {random3(0.01), random3(0.1)}, j.bias = {random3(0.01), random3(0.1)};
    Matrix15d Ji, Jj;
    term.Evaluate(i, j, &Ji, &Jj);
    for (int k = 0; k < 15; ++k) {
      const double h = 1e-6;
      const Vector15d d = h * Vector15d::Unit(k);
      const Vector15d di = (term.Evaluate(Moved(i, d), j, nullptr, nullptr) -
                            term.Evaluate(Moved(i, -d), j, nullptr, nullptr)) /
                           (2 * h);
      const Vector15d dj = (term.Evaluate(i, Moved(j, d), nullptr, nullptr) -
                            term.Evaluate(i, Moved(j, -d), nullptr, nullptr)) /
                           (2 * h);
      EXPECT_LT((di - Ji.col(k)).norm(), 1e-5 * Ji.norm()) << "i, column " << k;
      EXPECT_LT((dj - Jj.col(k)).norm(), 1e-5 * Jj.norm()) << "j, column " << k;
    }
  }
}

TEST(ImuTerm, VanishesOnTheTrueMotion) {
  const synthetic::Motion motion;
  const Preintegration pre(motion.Samples(200'000, 225'000, {}), {}, ImuNoise{7e-4, 1.3e-3, 7e-6, 6e-5});
  const Vector15d r =
      ImuTerm(&pre, 9.81, 1.0).Evaluate(motion.State(0.2), motion.State(0.225), nullptr, nullptr);
  EXPECT_LT(r.norm(), 1.0);  // integration error well below the sensor's noise
}

TEST(PriorFactor, JacobianMatchesNumericDerivative) {
  StatePrior prior;
  prior.mean.T_map_body = {ExpSO3({0.5, 1.0, -0.7}), {3, 2, 1}};
  const Matrix15d a = Matrix15d::Random();
  prior.information = a * a.transpose();
  const PriorFactor factor(prior);
  BodyState s = prior.mean;
  s.T_map_body = s.T_map_body.Plus((Vector6d() << 0.1, 0.2, 0.3, 0.4, -0.3, 0.2).finished());
  const auto evaluate = [&](const BodyState& x, double** jacobians) {
    const StateBlocks b = ToBlocks(x);
    const double* parameters[] = {b.pose.data(), b.motion.data()};
    Vector15d r;
    EXPECT_TRUE(factor.Evaluate(parameters, r.data(), jacobians));
    return r;
  };
  Eigen::Matrix<double, 15, 7, Eigen::RowMajor> Jp;
  Eigen::Matrix<double, 15, 9, Eigen::RowMajor> Jm;
  double* jacobians[] = {Jp.data(), Jm.data()};
  const Vector15d r = evaluate(s, jacobians);
  const Vector15d d = Minus(s, prior.mean);
  EXPECT_NEAR(r.squaredNorm(), d.dot(prior.information * d), 1e-9);
  Matrix15d J;
  J << Jp.leftCols<6>(), Jm;
  for (int k = 0; k < 15; ++k) {
    const Vector15d e = 1e-6 * Vector15d::Unit(k);
    const Vector15d numeric = (evaluate(Moved(s, e), nullptr) - evaluate(Moved(s, -e), nullptr)) / 2e-6;
    EXPECT_LT((numeric - J.col(k)).norm(), 1e-5 * J.norm()) << k;
  }
}

TEST(Marginalize, EqualsTheFullLinearSystem) {
  // Eliminating i must leave j with the same information and the same step as the joint system of both.
  const synthetic::Motion motion;
  const Preintegration pre(motion.Samples(0, 25'000, {}), {}, ImuNoise{7e-4, 1.3e-3, 7e-6, 6e-5});
  const ImuTerm term(&pre, 9.81, 2.0);
  const BodyState i = motion.State(0), j = Moved(motion.State(0.025), 1e-4 * Vector15d::Ones());
  StatePrior prior{Moved(i, 1e-3 * Vector15d::Ones()), Matrix15d::Identity() * 1e4};
  AlignmentTerm alignment;
  alignment.hessian = 1e6 * Eigen::Matrix<double, 6, 6>::Identity();
  alignment.gradient.setConstant(20);
  const StatePrior next = Marginalize(prior, alignment, KeyframeLink(term), i, j);

  Matrix15d Ji, Jj;
  const Vector15d r = term.Evaluate(i, j, &Ji, &Jj);
  Eigen::Matrix<double, 30, 30> H = Eigen::Matrix<double, 30, 30>::Zero();
  Eigen::Matrix<double, 30, 1> g;
  H.topLeftCorner<15, 15>() = Ji.transpose() * Ji + prior.information;
  H.topLeftCorner<6, 6>() += alignment.hessian;
  H.topRightCorner<15, 15>() = Ji.transpose() * Jj;
  H.bottomLeftCorner<15, 15>() = Jj.transpose() * Ji;
  H.bottomRightCorner<15, 15>() = Jj.transpose() * Jj;
  g << Ji.transpose() * r + prior.information * Minus(i, prior.mean), Jj.transpose() * r;
  g.head<6>() += alignment.gradient;
  const Eigen::Matrix<double, 30, 1> step = -H.ldlt().solve(g);
  EXPECT_LT((Minus(next.mean, j) - step.tail<15>()).norm(), 1e-3 * step.tail<15>().norm());
  const Matrix15d covariance = H.inverse().bottomRightCorner<15, 15>();
  EXPECT_LT((next.information * covariance - Matrix15d::Identity()).norm(), 1e-3);
}

}  // namespace
}  // namespace evit
