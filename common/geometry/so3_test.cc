// Rotations: exponential map, logarithm and Jacobians, from no rotation to nearly half a turn.
#include "common/geometry/so3.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "common/geometry/se3.h"

namespace evit {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Rotation vectors of many sizes in random directions; the tiny ones take the series, the rest the closed
// form.
std::vector<Vector3d> RotationVectors() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vector3d> all{Vector3d::Zero()};
  for (const double angle : {1e-12, 1e-8, 1e-5, 0.99e-4, 1.01e-4, 1e-3, 0.1, 1.0, 2.0, 3.1, 3.14159}) {
    for (int k = 0; k < 10; ++k) {
      all.push_back(Vector3d(normal(random), normal(random), normal(random)).normalized() * angle);
    }
  }
  return all;
}

TEST(SO3, ExpIsTheMatrixExponential) {
  for (const Vector3d& phi : RotationVectors()) {
    Matrix3d sum = Matrix3d::Identity(), term = Matrix3d::Identity();
    for (int k = 1; k < 40; ++k) {
      term = (term * Hat(phi) / k).eval();
      sum += term;
    }
    EXPECT_NEAR(ExpSO3(phi).norm(), 1, 1e-15);
    EXPECT_LT((ExpSO3(phi).toRotationMatrix() - sum).norm(), 1e-13) << phi.transpose();
  }
}

TEST(SO3, LogInvertsExpAndTakesTheShorterWay) {
  for (const Vector3d& phi : RotationVectors()) {
    const Quaterniond q = ExpSO3(phi);
    const double tolerance = 1e-13 + 1e-12 * phi.norm();
    EXPECT_LT((LogSO3(q) - phi).norm(), tolerance) << phi.transpose();
    EXPECT_LT((LogSO3(Quaterniond(-q.coeffs())) - phi).norm(), tolerance) << "-q is the same rotation";
  }
  const Vector3d long_way(0, 0, 1.5 * EIGEN_PI);
  EXPECT_LT((LogSO3(ExpSO3(long_way)) - Vector3d(0, 0, -0.5 * EIGEN_PI)).norm(), 1e-12);
}

TEST(SO3, RightJacobianIsTheDerivativeOfExp) {
  for (const Vector3d& phi : RotationVectors()) {
    Matrix3d numeric;
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = kStep * Vector3d::Unit(k);
      numeric.col(k) = (LogSO3(ExpSO3(phi).conjugate() * ExpSO3(phi + d)) -
                        LogSO3(ExpSO3(phi).conjugate() * ExpSO3(phi - d))) /
                       (2 * kStep);
    }
    EXPECT_LT((RightJacobianSO3(phi) - numeric).norm(), 1e-8) << phi.transpose();
  }
}

TEST(SO3, InverseRightJacobianIsTheInverse) {
  for (const Vector3d& phi : RotationVectors()) {
    EXPECT_LT((RightJacobianSO3(phi) * RightJacobianInverseSO3(phi) - Matrix3d::Identity()).norm(), 1e-8)
        << phi.transpose();
  }
}

TEST(SE3, ComposesInvertsAndMovesPoints) {
  const SE3 a(ExpSO3({0.3, -1.2, 2.0}), {1, -2, 3}), b(ExpSO3({-2.0, 0.1, 0.4}), {-4, 0.5, 0.2});
  const Vector3d x(0.7, -0.1, 2.5);
  EXPECT_LT(((a * b) * x - a * (b * x)).norm(), 1e-14);
  EXPECT_LT((a.Inverse() * (a * x) - x).norm(), 1e-14);
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = a.R();
  m.topRightCorner<3, 1>() = a.p;
  EXPECT_LT((SE3(m) * x - a * x).norm(), 1e-14);
}

TEST(SE3, PlusMovesThePositionInTheOuterFrameAndTheRotationOnTheRight) {
  const SE3 a(ExpSO3({0.3, -1.2, 2.0}), {1, -2, 3});
  Eigen::Matrix<double, 6, 1> d;
  d << 0.1, 0.2, -0.3, 0.01, -0.4, 0.2;
  const SE3 moved = a.Plus(d);
  EXPECT_LT((moved.p - Vector3d(1.1, -1.8, 2.7)).norm(), 1e-15);
  EXPECT_LT((LogSO3(a.q.conjugate() * moved.q) - Vector3d(0.01, -0.4, 0.2)).norm(), 1e-14);
}

TEST(SE3, InterpolatesOnTheGeodesic) {
  const SE3 a(ExpSO3({0.3, -1.2, 0.5}), {1, -2, 3}), b(ExpSO3({0.8, 0.1, 0.4}), {2, 0, 3});
  const SE3 half = Interpolate(a, b, 0.5);
  EXPECT_LT((half.p - Vector3d(1.5, -1, 3)).norm(), 1e-15);
  EXPECT_NEAR(AngularDistance(a.q, half.q), AngularDistance(half.q, b.q), 1e-12);
  EXPECT_NEAR(AngularDistance(a.q, b.q), 2 * AngularDistance(a.q, half.q), 1e-12);
}

}  // namespace
}  // namespace evit
