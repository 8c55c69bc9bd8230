#include "common/tracking/event_alignment.h"

#include <gtest/gtest.h>

#include "common/geometry/degrees.h"
#include "common/tracking/kernel_lanes.h"
#include "common/tracking/reference_alignment.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

class RobustKernelTest : public ::testing::TestWithParam<NamedKernel> {};
INSTANTIATE_TEST_SUITE_P(Kernels, RobustKernelTest, ::testing::ValuesIn(kRobustKernels),
                         [](const auto& info) { return std::string(info.param.name); });

constexpr float kSquares[kLanes] = {0,    1e-4F, 0.01F, 0.1F, 0.3F, 0.48F, 0.5F, 0.7F,
                                    1.0F, 1.5F,  2.0F,  4.0F, 9.0F, 10.2F, 30.F, 100.F};

TEST_P(RobustKernelTest, LanesGiveTheFormulasValueAndSlope) {
  const RobustKernel kernel{GetParam().kind, 0.7};
  alignas(64) float slope[kLanes];
  double before = 0;
  for (int n = 1; n <= kLanes; ++n) {  // lanes from n on must not count
    const double sum = KernelLanes(LaneKernel(kernel), kSquares, n, slope);
    const KernelValue expected = ReferenceKernel(kernel, kSquares[n - 1]);
    EXPECT_NEAR(sum - before, expected.rho, 1e-6 + 2e-6 * expected.rho) << kSquares[n - 1];
    EXPECT_NEAR(slope[n - 1], expected.slope, 1e-6) << kSquares[n - 1];
    before = sum;
  }
}

TEST_P(RobustKernelTest, SlopeIsTheDerivativeAndTheKernelIsConcave) {
  const RobustKernel kernel{GetParam().kind, 0.7};
  alignas(64) float slope[kLanes];
  KernelLanes(LaneKernel(kernel), kSquares, kLanes, slope);
  for (int l = 1; l < kLanes; ++l) {
    const double s = kSquares[l], h = 1e-6;
    const KernelValue here = ReferenceKernel(kernel, s);
    const double up = ReferenceKernel(kernel, s + h).rho, down = ReferenceKernel(kernel, s - h).rho;
    EXPECT_NEAR(slope[l], (up - down) / (2 * h), 1e-5) << s;
    EXPECT_GE(here.rho, s * slope[l] - 1e-6 * s);  // what EventAlignmentFactor's seventh row rests on
    EXPECT_LE(slope[l], slope[l - 1]);
  }
}

struct Frame {
  const char* name;
  SE3 T_map_room;  // the same scene seen in another map frame
};

std::vector<Frame> Frames() {
  const auto roll = [](double deg) {
    return ExpSO3(Eigen::Vector3d(1, 0.2, -0.3).normalized() * deg * kRadiansPerDegree);
  };
  return {{"origin", {}},
          {"roll 30", {roll(30), {0, 0, 0}}},
          {"roll 90, 7 m off", {roll(90), {4, -5, 3}}},
          {"roll 170, 100 m off", {roll(170), {-80, 60, 10}}}};
}

std::vector<Eigen::Vector3f> Moved(const SE3& T, const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> moved;
  moved.reserve(points.size());
  for (const auto& p : points) moved.push_back((T * p.cast<double>()).cast<float>());
  return moved;
}

TEST_P(RobustKernelTest, EveryAlignmentIsTheReferences) {
  for (const auto model : {Camera::Model::kPlumbBob, Camera::Model::kEquidistant}) {
    AlignmentSettings settings = synthetic::Alignment(model);
    settings.kernel = {GetParam().kind, 0.8};
    for (const Frame& frame : Frames()) {
      const auto points = Moved(frame.T_map_room, synthetic::RoomPoints());
      const SurfaceField field(synthetic::DrawSurface(settings, points, frame.T_map_room), 2);
      // Turned so far that some points leave the image.
      const SE3 pose = frame.T_map_room * SE3(ExpSO3({0.04, -0.03, 0.15}), {0.006, -0.008, 0.004});
      std::vector<Eigen::Vector3d> exact;
      exact.reserve(points.size() + 1);
      for (const auto& p : points) exact.push_back(p.cast<double>());
      exact.push_back(frame.T_map_room * Eigen::Vector3d(-2, 0.1, 0));  // behind the camera
      std::vector<Eigen::Vector3f> rounded = points;
      rounded.push_back(exact.back().cast<float>());
      for (int level = 0; level < 2; ++level) {
        const AlignmentTerm expected = ReferenceAlignment(settings, field.image(level), level, exact, pose);
        const AlignmentTerm got = EvaluateAlignment(settings, field, level, rounded, pose, true);
        EXPECT_NEAR(got.cost, expected.cost, 1e-5 * expected.cost) << frame.name;
        EXPECT_LT((got.gradient - expected.gradient).norm(), 3e-3 * expected.gradient.norm()) << frame.name;
        EXPECT_LT((got.hessian - expected.hessian).norm(), 3e-3 * expected.hessian.norm()) << frame.name;
      }
    }
  }
}

TEST(EventAlignment, GradientMatchesNumericDerivative) {
  for (const auto model : {Camera::Model::kPlumbBob, Camera::Model::kEquidistant}) {
    const AlignmentSettings settings = synthetic::Alignment(model);
    for (const Frame& frame : Frames()) {
      const auto points = Moved(frame.T_map_room, synthetic::RoomPoints());
      const SurfaceField field(synthetic::DrawSurface(settings, points, frame.T_map_room), 2);
      const SE3 pose = frame.T_map_room * SE3(ExpSO3({0.004, -0.003, 0.005}), {0.006, -0.008, 0.004});
      for (int level = 0; level < 2; ++level) {
        const AlignmentTerm term = EvaluateAlignment(settings, field, level, points, pose, true);
        for (int k = 0; k < 6; ++k) {
          const double h = 2e-4;  // single precision resolves 1e-4 pixels
          const Vector6d d = h * Vector6d::Unit(k);
          const double up = EvaluateAlignment(settings, field, level, points, pose.Plus(d), false).cost;
          const double down = EvaluateAlignment(settings, field, level, points, pose.Plus(-d), false).cost;
          EXPECT_NEAR(term.gradient[k], (up - down) / (2 * h), 2e-3 * term.gradient.norm())
              << frame.name << ", level " << level << ", direction " << k;
        }
      }
    }
  }
}

TEST(EventAlignment, PointsBehindTheCameraCostButDoNotPull) {
  const AlignmentSettings settings = synthetic::Alignment();
  const SurfaceField field(cv::Mat(480, 640, CV_8UC1, cv::Scalar(10)), 1);
  const std::vector<Eigen::Vector3f> behind{{-2, 0, 0}, {-1, 0.1f, 0.2f}};
  const AlignmentTerm term = EvaluateAlignment(settings, field, 0, behind, SE3(), true);
  EXPECT_GT(term.cost, 1);
  EXPECT_EQ(term.gradient.norm(), 0);
  EXPECT_EQ(term.hessian.norm(), 0);
}

}  // namespace
}  // namespace evit
