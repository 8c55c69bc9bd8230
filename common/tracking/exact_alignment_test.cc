#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <random>

#include "common/tracking/event_alignment.h"
#include "common/tracking/reference_alignment.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

class ExactAlignmentTest : public ::testing::TestWithParam<NamedKernel> {
 protected:
  AlignmentSettings settings_ = synthetic::Alignment();
  std::vector<Eigen::Vector3f> room_ = synthetic::RoomPoints();
  SE3 pose_{ExpSO3({0.3, -0.1, 0.2}), {0.02, -0.03, 0.01}};
};
INSTANTIATE_TEST_SUITE_P(Kernels, ExactAlignmentTest, ::testing::ValuesIn(kRobustKernels),
                         [](const auto& info) { return std::string(info.param.name); });

// By differences of the gradient, which factors_test.cc holds against differences of the cost.
TEST_P(ExactAlignmentTest, IsTheCurvatureOfTheCostWhereThatIsAValley) {
  settings_.kernel = {GetParam().kind, 1.5};
  const SE3 pose;
  const SurfaceField field(synthetic::DrawSurface(settings_, room_, pose), 1);
  const AlignmentPoints points(room_);
  const Matrix6d information = EvaluateAlignmentExactly(settings_, field, points, pose).hessian;
  constexpr double kStep = 2e-4;  // a twentieth of a pixel: the spline's curvature jumps from pixel to pixel
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    const double up = EvaluateAlignment(settings_, field, 0, points, pose.Plus(step), true).gradient[i];
    const double down = EvaluateAlignment(settings_, field, 0, points, pose.Plus(-step), true).gradient[i];
    const double numeric = (up - down) / (2 * kStep);
    EXPECT_NEAR(information(i, i), numeric, 0.2 * std::abs(numeric)) << i;
  }
}

// Events that have nothing to do with the map: they say nothing of the pose. The solver's Hessian claims that
// they do.
TEST_P(ExactAlignmentTest, OfNoiseIsAFractionOfWhatTheSolversHessianClaims) {
  settings_.kernel = {GetParam().kind, 1};
  cv::Mat noise(settings_.camera().height, settings_.camera().width, CV_8UC1, cv::Scalar(255));
  std::mt19937 rng(1);
  for (int k = 0; k < 20'000; ++k) {
    noise.at<std::uint8_t>(static_cast<int>(rng() % 480), static_cast<int>(rng() % 640)) =
        static_cast<std::uint8_t>(rng() % 200);
  }
  cv::GaussianBlur(noise, noise, {}, 1.0);
  const SurfaceField field(noise, 1);
  const AlignmentPoints points(room_);
  const Matrix6d claimed = EvaluateAlignment(settings_, field, 0, points, pose_, true).hessian;
  const Matrix6d information = EvaluateAlignmentExactly(settings_, field, points, pose_).hessian;
  EXPECT_LT((claimed.inverse() * information).trace() / 6, 0.35);
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix6d>(information).eigenvalues().minCoeff(),
            -1e-9 * information.norm());
}

// Far up the slope the cost bends down: no step is taken for sure there, but neither is it flat.
TEST_P(ExactAlignmentTest, BendsOverARidgeWhereTheHessianIsFlat) {
  settings_.kernel = {GetParam().kind, 1.5};
  const SurfaceField field(synthetic::DrawSurface(settings_, room_, SE3()), 1);
  const AlignmentPoints points(room_);
  double flattest = 1;
  for (int k = 1; k <= 12; ++k) {  // to some widths of the valley
    Matrix6d bend;
    const SE3 pose(Eigen::Quaterniond::Identity(), {2e-3 * k, 0, 0});
    const Matrix6d hessian = EvaluateAlignmentExactly(settings_, field, points, pose, &bend).hessian;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> flat(hessian), bent(bend);
    flattest = std::min(flattest, flat.eigenvalues()[0] / flat.eigenvalues()[5]);
    EXPECT_GT(bent.eigenvalues()[0], 1e-6 * bent.eigenvalues()[5]) << k;
    EXPECT_GE((bend - hessian).trace(), -1e-9 * bend.trace()) << k;
  }
  EXPECT_LT(flattest, 1e-9);
}

TEST_P(ExactAlignmentTest, WithoutPointsInViewIsNothing) {
  const SurfaceField field(synthetic::DrawSurface(settings_, room_, pose_), 1);
  EXPECT_EQ(EvaluateAlignmentExactly(settings_, field, AlignmentPoints(), pose_).hessian.norm(), 0);
  SE3 away = pose_;
  away.q = away.q * ExpSO3({0, 0, 3});
  EXPECT_EQ(EvaluateAlignmentExactly(settings_, field, AlignmentPoints(room_), away).hessian.norm(), 0);
}

}  // namespace
}  // namespace evit
