#include "common/tracking/chain_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace evit {
namespace {

constexpr int kStates = 4;
using Big = Eigen::Matrix<double, 15 * kStates, 15 * kStates>;

std::mt19937 g_random(3);

Matrix15d Random15() {
  std::normal_distribution<double> normal;
  return Matrix15d::NullaryExpr([&] { return normal(g_random); });
}

// Neighbours joined by |A a + B b - c|^2 / 2, and each state held at its place by |x - m|^2 / 2, over the
// vectors that the states' tangents at the identity make.
struct Springs {
  Springs() {
    for (int k = 0; k + 1 < kStates; ++k) {
      A.push_back(Random15()), B.push_back(Random15()), c.emplace_back(Random15().col(0));
    }
    for (int k = 0; k < kStates; ++k) m.emplace_back(Random15().col(0));
  }

  ChainModel At(const std::vector<Vector15d>& x) const {
    ChainModel model(x.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      model.cost += 0.5 * (x[k] - m[k]).squaredNorm();
      model.gradient[k] += x[k] - m[k];
      model.diagonal[k] += Matrix15d::Identity();
      if (k + 1 == x.size()) break;
      const Vector15d r = A[k] * x[k] + B[k] * x[k + 1] - c[k];
      model.cost += 0.5 * r.squaredNorm();
      model.gradient[k] += A[k].transpose() * r;
      model.gradient[k + 1] += B[k].transpose() * r;
      model.diagonal[k] += A[k].transpose() * A[k];
      model.diagonal[k + 1] += B[k].transpose() * B[k];
      model.upper[k] = A[k].transpose() * B[k];
    }
    return model;
  }

  std::vector<Matrix15d> A, B;
  std::vector<Vector15d> c, m;
};

// Rotations aside, a state is its tangent.
Vector15d Straight(const BodyState& s) {
  Vector15d x = Minus(s, BodyState());
  x.segment<3>(3).setZero();
  return x;
}

TEST(MinimizeChain, OfAQuadraticFunctionIsTheSolutionOfTheWholeSystem) {
  const Springs springs;
  const auto evaluate = [&](const std::vector<BodyState>& states) {
    std::vector<Vector15d> x;
    for (const BodyState& s : states) x.push_back(Straight(s));
    ChainModel model = springs.At(x);
    for (std::size_t k = 0; k < x.size(); ++k) {  // rotations stay where they are
      model.gradient[k].segment<3>(3).setZero();
      model.diagonal[k].middleCols<3>(3).setZero();
      model.diagonal[k].middleRows<3>(3).setZero();
      model.diagonal[k].block<3, 3>(3, 3).setIdentity();
      if (k + 1 == x.size()) break;
      model.upper[k].middleCols<3>(3).setZero();
      model.upper[k].middleRows<3>(3).setZero();
    }
    return model;
  };
  std::vector<BodyState> states(kStates);
  const ChainModel first = evaluate(states);
  Big H = Big::Zero();
  Eigen::Matrix<double, 15 * kStates, 1> g;
  for (int k = 0; k < kStates; ++k) {
    H.block<15, 15>(15 * k, 15 * k) = first.diagonal[static_cast<std::size_t>(k)];
    g.segment<15>(15 * k) = first.gradient[static_cast<std::size_t>(k)];
    if (k + 1 == kStates) break;
    H.block<15, 15>(15 * k, 15 * (k + 1)) = first.upper[static_cast<std::size_t>(k)];
    H.block<15, 15>(15 * (k + 1), 15 * k) = first.upper[static_cast<std::size_t>(k)].transpose();
  }
  const Eigen::Matrix<double, 15 * kStates, 1> expected = -H.ldlt().solve(g);

  ChainOptions options;
  options.max_iterations = 50;
  options.least_gain = 1e-12;
  const ChainSummary summary = MinimizeChain(options, evaluate, &states);
  EXPECT_TRUE(summary.usable);
  EXPECT_LE(summary.iterations, 12);
  for (int k = 0; k < kStates; ++k) {
    const Vector15d x = Straight(states[static_cast<std::size_t>(k)]);
    EXPECT_LT((x - expected.segment<15>(15 * k)).norm(), 1e-4 * (1 + x.norm())) << k;
  }
}

// A rotation found from vectors it turns: the model is right only near the solution, and a first step taken
// in full would overshoot.
TEST(MinimizeChain, ConvergesWhereTheModelHoldsNearTheSolutionOnly) {
  const Eigen::Quaterniond truth = ExpSO3({1.5, -1.2, 0.9});
  const Eigen::Matrix3d vectors = Eigen::Matrix3d::Identity();
  const auto evaluate = [&](const std::vector<BodyState>& states) {
    ChainModel model(1);
    const Eigen::Matrix3d R = states[0].T_map_body.R();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d r = R * vectors.col(k) - truth * vectors.col(k);
      const Eigen::Matrix3d J = -R * Hat(vectors.col(k));
      model.cost += 0.5 * r.squaredNorm();
      model.gradient[0].segment<3>(3) += J.transpose() * r;
      model.diagonal[0].block<3, 3>(3, 3) += J.transpose() * J;
    }
    return model;
  };
  std::vector<BodyState> states(1);
  ChainOptions options;
  options.max_iterations = 30;
  options.least_gain = 1e-10;
  EXPECT_TRUE(MinimizeChain(options, evaluate, &states).usable);
  EXPECT_LT(LogSO3(truth.conjugate() * states[0].T_map_body.q).norm(), 1e-4);
}

TEST(MinimizeChain, LeavesTheStatesWhereNothingPullsAndSaysWhereTheObjectiveIsNoNumber) {
  std::vector<BodyState> states(2);
  states[1].velocity.x() = 3;
  const auto flat = [](const std::vector<BodyState>& s) { return ChainModel(s.size()); };
  EXPECT_TRUE(MinimizeChain({}, flat, &states).usable);
  EXPECT_EQ(states[1].velocity.x(), 3);
  const auto broken = [](const std::vector<BodyState>& s) {
    ChainModel model(s.size());
    model.cost = std::numeric_limits<double>::quiet_NaN();
    return model;
  };
  EXPECT_FALSE(MinimizeChain({}, broken, &states).usable);
  EXPECT_EQ(states[1].velocity.x(), 3);
}

}  // namespace
}  // namespace evit
