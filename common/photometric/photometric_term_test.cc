#include "common/photometric/photometric_term.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "common/photometric/photometric_factor.h"
#include "common/tracking/state.h"
#include "tests/helpers/photometric_room.h"

namespace evit {
namespace {

constexpr double kThreshold = 0.2, kSeconds = 0.02;

// A moving camera at some pose in a room that may lie anywhere: its events and the points of the true view.
struct Frame {
  test::Room room;
  SE3 pose;
  Twist twist;
  EventImage events{cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), 1, 1, 1};
  PhotometricScene scene;

  explicit Frame(const SE3& T_map_room, const SE3& T_room_body, int level = 0)
      : pose(T_map_room * T_room_body) {
    room.T_map_room = T_map_room;
    twist << T_map_room.q * Eigen::Vector3d(0.1, 0.3, -0.2), T_map_room.q * Eigen::Vector3d(0.3, -0.2, 0.25);
    const Camera camera = test::EventCamera();
    const auto seen_at = [&](double t) { return room.See(camera, At(t) * test::BodyCamera()); };
    events = EventImage(test::CountBetween(seen_at(-kSeconds / 2), seen_at(kSeconds / 2), kThreshold),
                        kThreshold, 1, 2);
    const PhotometricView view = room.See(ViewCamera(camera, 0), pose * test::BodyCamera());
    scene.T_camera_body = test::BodyCamera().Inverse();
    scene.camera = camera;
    scene.events = &events;
    scene.level = level;
    const SE3 T = (pose * test::BodyCamera()).Inverse();
    for (const GradientPoint& g : FindGradientPoints(view, level, 1, 0.02, 3000)) {
      Eigen::Vector2d pixel;  // as the tracker does: a point that leaves the image is not smooth
      if (camera.Project(T * g.point, &pixel) && camera.Contains(pixel, 20)) scene.points.push_back(g);
    }
    scene.origin = pose.p;
    scene.event_norm = 0.3;
    scene.weight = 0.1;
    scene.robust_scale = 1.5;
    scene.Prepare();
  }
  Frame(const Frame&) = delete;
  SE3 At(double t) const { return {ExpSO3(t * twist.tail<3>()) * pose.q, pose.p + t * twist.head<3>()}; }
};

const SE3 kFar(ExpSO3({0.3, -0.4, 2.2}), {40, -25, 3});
const SE3 kRolls[] = {
    {}, {ExpSO3({0.5236, 0, 0}), {0.1, 0.2, 0}}, {ExpSO3({1.5708, 0.1, 0}), {-0.2, 0.1, 0.1}}};

Eigen::Matrix<double, 12, 1> Step(int k, double h) {
  Eigen::Matrix<double, 12, 1> d = Eigen::Matrix<double, 12, 1>::Zero();
  d[k] = h;
  return d;
}

TEST(PhotometricTerm, GradientIsThatOfTheCost) {
  for (const SE3& where : {SE3(), kFar}) {
    for (const SE3& roll : kRolls) {
      for (const int level : {0, 1}) {
        const Frame frame(where, roll, level);
        ASSERT_GT(frame.scene.points.size(), 500u);
        // Off the optimum, where every derivative is something.
        const SE3 pose = frame.pose.Plus((Vector6d() << 0.01, -0.02, 0.01, 0.01, 0.008, -0.01).finished());
        const Twist twist = frame.twist + (Twist() << 0.05, -0.1, 0.1, 0.1, 0.1, -0.05).finished();
        const PhotometricTerm term = EvaluatePhotometric(frame.scene, pose, twist, true);
        EXPECT_EQ(term.cost, EvaluatePhotometric(frame.scene, pose, twist, false).cost);
        for (int k = 0; k < 12; ++k) {
          const double h = 5e-4;  // points and images are floats
          const auto cost = [&](double s) {
            const auto d = Step(k, s * h);
            return EvaluatePhotometric(frame.scene, pose.Plus(d.head<6>()), twist + d.tail<6>(), false).cost;
          };
          const double numeric = (cost(1) - cost(-1)) / (2 * h);
          EXPECT_NEAR(term.gradient[k], numeric, 2e-3 * std::abs(numeric) + 0.03) << k << " level " << level;
        }
        EXPECT_GE(term.hessian.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(),
                  -1e-6 * term.hessian.norm());
      }
    }
  }
}

TEST(PhotometricTerm, NeitherSpeedNorThresholdMatter) {
  const Frame frame({}, kRolls[1]);
  const double cost = EvaluatePhotometric(frame.scene, frame.pose, frame.twist, false).cost;
  EXPECT_NEAR(EvaluatePhotometric(frame.scene, frame.pose, 3 * frame.twist, false).cost, cost, 1e-6 * cost);
  EXPECT_GT(EvaluatePhotometric(frame.scene, frame.pose, -frame.twist, false).cost, 1.5 * cost);
}

TEST(PhotometricTerm, TheTruthIsBetterThanAnythingAroundIt) {
  const Frame frame(kFar, kRolls[2]);
  const double cost = EvaluatePhotometric(frame.scene, frame.pose, frame.twist, false).cost;
  for (int k = 0; k < 6; ++k) {
    for (const double h : {-0.03, 0.03}) {
      const auto d = Step(k, h);
      EXPECT_GT(EvaluatePhotometric(frame.scene, frame.pose.Plus(d.head<6>()), frame.twist, false).cost,
                cost);
    }
  }
  EXPECT_GT(MeasurePhotometric(frame.scene, frame.pose, frame.twist).correlation, 0.8);
}

TEST(PhotometricTerm, FitTwistFindsTheMotionInMetresASecond) {
  for (const SE3& roll : kRolls) {
    const Frame frame(kFar, roll);
    const TwistFit fit = FitTwist(frame.scene, frame.pose, kSeconds, Twist::Zero(), Vector6d::Constant(10));
    EXPECT_LT((fit.twist - frame.twist).norm(), 0.2 * frame.twist.norm())
        << fit.twist.transpose() << " instead of " << frame.twist.transpose();
    EXPECT_GT(fit.event_rms, 0);
  }
}

TEST(PhotometricFactor, RowsGiveTheGradientAndTheExactCost) {
  const Frame frame(kFar, kRolls[1]);
  const SE3 pose = frame.pose.Plus((Vector6d() << 0.01, -0.02, 0.01, 0.01, 0, -0.01).finished());
  const PhotometricTerm term = EvaluatePhotometric(frame.scene, pose, frame.twist, true);
  const PhotometricFactor factor(&frame.scene);
  BodyState state;
  state.T_map_body = pose;
  const StateBlocks blocks = ToBlocks(state);
  const double* parameters[] = {blocks.pose.data(), frame.twist.data()};
  Eigen::Matrix<double, 13, 1> r, bare;
  Eigen::Matrix<double, 13, 7, Eigen::RowMajor> by_pose;
  Eigen::Matrix<double, 13, 6, Eigen::RowMajor> by_twist;
  double* jacobians[] = {by_pose.data(), by_twist.data()};
  ASSERT_TRUE(factor.Evaluate(parameters, r.data(), jacobians));
  ASSERT_TRUE(factor.Evaluate(parameters, bare.data(), nullptr));
  EXPECT_NEAR(0.5 * r.squaredNorm(), term.cost, 1e-9 * term.cost);
  EXPECT_NEAR(0.5 * bare.squaredNorm(), term.cost, 1e-9 * term.cost);
  Eigen::Matrix<double, 13, 12> J;
  J << by_pose.leftCols<6>(), by_twist;
  EXPECT_LT((J.transpose() * r - term.gradient).norm(), 1e-6 * term.gradient.norm());
  EXPECT_LT((J.transpose() * J - term.hessian).norm(), 1e-6 * term.hessian.norm());
}

TEST(MotionPriorFactor, JacobiansAreThoseOfTheResidual) {
  const SE3 mean(ExpSO3({1.4, 0.2, -0.3}), {10, -20, 3});
  const Twist twist = (Twist() << 1, 2, 3, -1, 0.5, 0.2).finished();
  const MotionPriorFactor factor(mean, twist, (Vector6d() << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6).finished(),
                                 Vector6d::Constant(0.7));
  const SE3 at = mean.Plus((Vector6d() << 0.1, 0.2, -0.3, 0.4, -0.2, 0.3).finished());
  const auto residual = [&](const SE3& pose, const Twist& t, double** jacobians) {
    BodyState state;
    state.T_map_body = pose;
    const StateBlocks blocks = ToBlocks(state);
    const double* parameters[] = {blocks.pose.data(), t.data()};
    Eigen::Matrix<double, 12, 1> r;
    EXPECT_TRUE(factor.Evaluate(parameters, r.data(), jacobians));
    return r;
  };
  Eigen::Matrix<double, 12, 7, Eigen::RowMajor> by_pose;
  Eigen::Matrix<double, 12, 6, Eigen::RowMajor> by_twist;
  double* jacobians[] = {by_pose.data(), by_twist.data()};
  const Twist off = twist + Twist::Constant(0.3);
  residual(at, off, jacobians);
  for (int k = 0; k < 12; ++k) {
    const auto d = Step(k, 1e-6);
    const Eigen::Matrix<double, 12, 1> numeric =
        (residual(at.Plus(d.head<6>()), off + d.tail<6>(), nullptr) -
         residual(at.Plus(-d.head<6>()), off - d.tail<6>(), nullptr)) /
        2e-6;
    const Eigen::Matrix<double, 12, 1> analytic = k < 6 ? by_pose.col(k).eval() : by_twist.col(k - 6).eval();
    EXPECT_LT((numeric - analytic).norm(), 1e-6) << k;
  }
  EXPECT_LT(residual(mean, twist, nullptr).norm(), 1e-12);
}

}  // namespace
}  // namespace evit
