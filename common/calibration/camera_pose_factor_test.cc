// The camera pose's residual against its definition and numeric derivatives.
#include "common/calibration/camera_pose_factor.h"

#include <gtest/gtest.h>

#include "common/tracking/state.h"

namespace evit {
namespace {

struct Blocks {
  StateBlocks body;
  std::array<double, 7> extrinsic{};
  std::array<double, 2> tilt{};
  double late = 0;

  std::array<const double*, 5> Pointers() const {
    return {body.pose.data(), body.motion.data(), extrinsic.data(), tilt.data(), &late};
  }
};

const Eigen::Vector3d kGyro(0.9, -1.4, 0.6);

Blocks Example(double tilt_rad) {
  BodyState state;
  state.T_map_body = {ExpSO3({0.3, -0.8, 1.9}), {1, -2, 0.5}};
  state.velocity = {0.8, -0.3, 0.4};
  state.bias.gyro = {0.02, -0.01, 0.03};
  Blocks b;
  b.body = ToBlocks(state);
  b.extrinsic =
      ToBlocks({SE3(ExpSO3({1.2, -1.2, 1.25}), {0.13, 0.08, 0.03}), Eigen::Vector3d::Zero(), {}}).pose;
  b.tilt = {tilt_rad, -0.6 * tilt_rad};
  b.late = 0.004;
  return b;
}

SE3 Predicted(const Blocks& b) {
  const BodyState s = FromBlocks(b.body);
  const SE3 moved(s.T_map_body.q * ExpSO3(b.late * (kGyro - s.bias.gyro)),
                  s.T_map_body.p + b.late * s.velocity);
  return SE3(ExpSO3({b.tilt[0], b.tilt[1], 0}), Eigen::Vector3d::Zero()) * moved *
         PoseFromBlock(b.extrinsic.data());
}

TEST(CameraPoseFactor, IsZeroWhereTheCameraIsAndCountsInSigmas) {
  const Blocks b = Example(0.05);
  Vector6d off;
  off << 0.01, 0, -0.02, 0, 0.03, 0;
  Vector6d r;
  CameraPoseFactor(Predicted(b), kGyro, 0.01, 0.02).Evaluate(b.Pointers().data(), r.data(), nullptr);
  EXPECT_LT(r.norm(), 1e-12);
  CameraPoseFactor(Predicted(b).Plus(off), kGyro, 0.01, 0.02)
      .Evaluate(b.Pointers().data(), r.data(), nullptr);
  Vector6d expected;
  expected << -1, 0, 2, 0, -1.5, 0;
  EXPECT_LT((r - expected).norm(), 1e-9);
}

TEST(CameraPoseFactor, JacobiansMatchNumericDerivatives) {
  for (const double tilt : {0.0, 0.05, 0.7}) {
    const Blocks b = Example(tilt);
    Vector6d off;
    off << 0.01, 0.02, -0.02, 0.1, 0.2, -0.1;
    const CameraPoseFactor factor(Predicted(b).Plus(off), kGyro, 0.1, 0.2);
    std::array<Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>, 5> J;
    const int size[5] = {7, 9, 7, 2, 1};
    std::array<double*, 5> pointers{};
    for (int k = 0; k < 5; ++k) {
      J[k].resize(6, size[k]);
      pointers[k] = J[k].data();
    }
    Vector6d r;
    factor.Evaluate(b.Pointers().data(), r.data(), pointers.data());
    const auto at = [&](int block, int column, double h) {
      Blocks moved = b;
      if (block == 0 || block == 2) {
        double* pose = block == 0 ? moved.body.pose.data() : moved.extrinsic.data();
        const SE3 T = PoseFromBlock(pose).Plus(h * Vector6d::Unit(column));
        Eigen::Map<Eigen::Vector3d>(pose + 0) = T.p;
        Eigen::Map<Eigen::Vector4d>(pose + 3) = T.q.coeffs();
      } else if (block == 1) {
        moved.body.motion[column] += h;
      } else if (block == 3) {
        moved.tilt[column] += h;
      } else {
        moved.late += h;
      }
      Vector6d value;
      factor.Evaluate(moved.Pointers().data(), value.data(), nullptr);
      return value;
    };
    for (int block = 0; block < 5; ++block) {
      const int columns = block == 0 || block == 2 ? 6 : size[block];
      for (int c = 0; c < columns; ++c) {
        const double h = 1e-6;
        const Vector6d numeric = (at(block, c, h) - at(block, c, -h)) / (2 * h);
        EXPECT_LT((J[block].col(c) - numeric).norm(), 1e-7 * (1 + numeric.norm()))
            << "tilt " << tilt << ", block " << block << ", column " << c;
      }
    }
  }
}

}  // namespace
}  // namespace evit
