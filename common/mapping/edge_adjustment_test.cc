#include "common/mapping/edge_adjustment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "common/geometry/degrees.h"

namespace evit {
namespace {

Camera TestCamera() {
  Camera camera;
  camera.width = 320, camera.height = 240;
  camera.fx = camera.fy = 300;
  camera.cx = 160, camera.cy = 120;
  return camera;
}

// An edge of 30 cm, 3 m ahead of a camera that moves by half a metre sideways, with a fifth of a pixel of
// noise.
class EdgeAdjustmentTest : public testing::Test {
 protected:
  // The edge is upright, or its upper end slants away.
  void SeeEdge(double slant_deg) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0, 0.2F), tilt(0, 0.02F);
    const Camera camera = TestCamera();
    const Eigen::Vector3d along = Along(slant_deg);
    views_.clear();
    for (int k = 0; k < 30; ++k) {
      const SE3 pose(Eigen::Quaterniond::Identity(), {0.5 * k / 29 - 0.25, 0, 0});
      const PinholeView pinhole(pose, camera);
      std::vector<EdgePixel> edges;
      const float off = noise(random), angle = tilt(random);
      for (double s = -0.15; s <= 0.15; s += 0.01) {
        const Eigen::Vector3d p = pinhole.InCamera(Eigen::Vector3d(0, 0, 3) + s * along);
        const Eigen::Vector2d tangent = pinhole.Jacobian(p) * along;
        EdgePixel edge;
        edge.pixel = pinhole.Pixel(p).cast<float>() + Eigen::Vector2f(off, 0);
        edge.normal =
            Eigen::Rotation2Df(angle) * Eigen::Vector2d(-tangent.y(), tangent.x()).normalized().cast<float>();
        edges.push_back(edge);
      }
      views_.push_back({pose, camera, EdgeImage(camera.width, camera.height, std::move(edges), true)});
    }
  }

  // Of one point on the edge, found `deep` m too far off and to slant away by `slant_deg`.
  MappedPoint Adjusted(double deep, double slant_deg) {
    MappedPoint point;
    point.position = {0, 0, 3 + deep};
    point.direction = Along(slant_deg);
    point.sigma = 0.05;
    std::vector<MappedPoint> points{point};
    EdgeAdjustmentOptions options;
    options.move_poses = false;
    EdgeAdjustment(&views_, options, 1).Run(&points);
    return points.empty() ? MappedPoint{} : points.front();
  }
  static Eigen::Vector3d Along(double slant_deg) {
    const double slant = slant_deg * kRadiansPerDegree;
    return {0, -std::cos(slant), std::sin(slant)};
  }
  static double SlantDegrees(const MappedPoint& point) {
    return std::asin(point.direction.z()) * kDegreesPerRadian;
  }

  std::vector<PosedEdges> views_;
};

TEST_F(EdgeAdjustmentTest, FindsThePlaceOfAnEdgeAndItsSigma) {
  SeeEdge(0);
  const MappedPoint point = Adjusted(0.06, 0);
  EXPECT_NEAR(point.position.z(), 3, 0.02);
  EXPECT_NEAR(point.position.x(), 0, 0.002);
  EXPECT_EQ(point.views, 30);
  EXPECT_GT(point.sigma, 0.01);
  EXPECT_LT(point.sigma, 0.06);
}

// Else its depth would seem to be a matter of where along the edge it lies, and of no account.
TEST_F(EdgeAdjustmentTest, TurnsAnEdgeThatSeemsToSlant) {
  SeeEdge(0);
  const MappedPoint point = Adjusted(0.06, 30), upright = Adjusted(0.06, 0);
  EXPECT_LT(std::abs(SlantDegrees(point)), 15);
  EXPECT_NEAR(point.position.z(), 3, 0.03);
  EXPECT_NEAR(point.sigma, upright.sigma, 0.2 * upright.sigma);
}

TEST_F(EdgeAdjustmentTest, KeepsTheSlantThatTheViewsShow) {
  SeeEdge(30);
  EXPECT_NEAR(SlantDegrees(Adjusted(0, 30)), 30, 8);
}

}  // namespace
}  // namespace evit
