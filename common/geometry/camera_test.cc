// Both camera models: projection against the published formulas, Jacobians against numeric derivatives, and
// rays outside the lens model's range refused instead of wrapped back into the image.
#include "common/geometry/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/geometry/degrees.h"

namespace evit {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Camera PlumbBob() {  // VECtor's event camera, with a fifth coefficient
  return {Camera::Model::kPlumbBob,
          640,
          480,
          327.3,
          327.5,
          305.0,
          235.4,
          {-0.032, 0.042, -0.0005, -0.001, 0.003}};
}

Camera Barrel() {  // a lens whose polynomial turns back inside the front half space
  return {Camera::Model::kPlumbBob, 640, 480, 300, 300, 320, 240, {-0.30, 0.02, 0, 0, 0}};
}

Camera Equidistant() {
  return {Camera::Model::kEquidistant, 640, 480, 190, 191, 318, 241, {-0.0169, 0.0037, -0.0044, 0.0009, 0}};
}

std::vector<Vector3d> Points(double half_field_of_view) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> angle(0, half_field_of_view), turn(0, 2 * EIGEN_PI), depth(0.2, 8);
  std::vector<Vector3d> points{{0, 0, 1}, {1e-10, -1e-10, 2}};
  for (int k = 0; k < 500; ++k) {
    const double a = angle(random), b = turn(random);
    points.push_back(Vector3d(std::tan(a) * std::cos(b), std::tan(a) * std::sin(b), 1) * depth(random));
  }
  return points;
}

TEST(Camera, PlumbBobIsRosFormula) {
  const Camera camera = PlumbBob();
  const Vector3d point(0.8, -0.5, 1.6);
  Vector2d pixel;
  ASSERT_TRUE(camera.Project(point, &pixel));
  const double x = 0.5, y = -0.3125, r2 = x * x + y * y;
  const double radial = 1 - 0.032 * r2 + 0.042 * r2 * r2 + 0.003 * r2 * r2 * r2;
  const double xd = x * radial + 2 * -0.0005 * x * y - 0.001 * (r2 + 2 * x * x);
  const double yd = y * radial - 0.0005 * (r2 + 2 * y * y) + 2 * -0.001 * x * y;
  EXPECT_NEAR(pixel.x(), 327.3 * xd + 305.0, 1e-10);
  EXPECT_NEAR(pixel.y(), 327.5 * yd + 235.4, 1e-10);
}

TEST(Camera, EquidistantIsProportionalToTheAngle) {
  Camera camera = Equidistant();
  camera.distortion = {};
  for (const double degrees : {5.0, 40.0, 80.0}) {
    const double angle = degrees * kRadiansPerDegree;
    Vector2d pixel;
    ASSERT_TRUE(camera.Project({std::sin(angle), 0, std::cos(angle)}, &pixel));
    EXPECT_NEAR(pixel.x(), 318 + 190 * angle, 1e-9);
  }
}

TEST(Camera, JacobiansMatchNumericDerivatives) {
  for (const Camera& camera : {PlumbBob(), Equidistant()}) {
    for (const Vector3d& point : Points(1.1)) {
      Vector2d pixel, up, down;
      Eigen::Matrix<double, 2, 3> jacobian, numeric;
      ASSERT_TRUE(camera.Project(point, &pixel, &jacobian));
      for (int k = 0; k < 3; ++k) {
        const Vector3d d = 1e-6 * Vector3d::Unit(k);
        ASSERT_TRUE(camera.Project(point + d, &up) && camera.Project(point - d, &down));
        numeric.col(k) = (up - down) / 2e-6;
      }
      EXPECT_LT((jacobian - numeric).norm(), 1e-6 * jacobian.norm() + 1e-5)
          << CameraModelName(camera.model) << " at " << point.transpose();
    }
  }
}

TEST(Camera, UnprojectInvertsProject) {
  for (const Camera& camera : {PlumbBob(), Equidistant()}) {
    int inside = 0;
    for (const Vector3d& point : Points(1.0)) {
      Vector2d pixel;
      Vector3d ray;
      if (!camera.Project(point, &pixel) || !camera.Contains(pixel)) continue;
      ++inside;
      ASSERT_TRUE(camera.Unproject(pixel, &ray)) << pixel.transpose();
      EXPECT_LT((ray - point / point.z()).norm(), 1e-9) << CameraModelName(camera.model);
    }
    EXPECT_GT(inside, 100);
  }
}

// Where the radial polynomial of a lens turns back, points far outside the view would land in the image.
TEST(Camera, APointBeyondTheLensModelIsRefusedNotWrappedIntoTheImage) {
  const Camera camera = Barrel();
  double last = 0, reach = 0;
  for (double r = 0; r < 4.9; r += 0.01) {
    Vector2d pixel;
    if (!camera.Project({r, 0, 1}, &pixel)) continue;
    ASSERT_NEAR(r, reach, 0.0101) << "accepted again after it was refused";
    ASSERT_GE(pixel.x(), last) << "not monotonic at r = " << r;
    last = pixel.x();
    reach = r;
  }
  EXPECT_NEAR(reach, 1.139, 0.015);  // 1 - 0.9 r^2 + 0.1 r^4 = 0
}

TEST(Camera, PointsBehindAndNotFiniteOnesAreRefused) {
  const double nan = std::nan("");
  Vector2d pixel;
  for (const Camera& camera : {PlumbBob(), Equidistant()}) {
    for (const Vector3d& point : {Vector3d(0, 0, 0), Vector3d(0.1, 0.1, -1), Vector3d(0, 0, nan)}) {
      EXPECT_FALSE(camera.Project(point, &pixel)) << point.transpose();
    }
  }
}

TEST(Camera, ContainsCountsThePixelCentres) {
  const Camera camera = PlumbBob();
  EXPECT_TRUE(camera.Contains({0, 0}));
  EXPECT_TRUE(camera.Contains({639, 479}));
  EXPECT_FALSE(camera.Contains({639.01, 100}));
  EXPECT_FALSE(camera.Contains({5, 5}, 6));
  EXPECT_TRUE(camera.Contains({-5, 5}, -6));
  EXPECT_FALSE(camera.Contains({std::nan(""), 5}));
}

TEST(Camera, ModelNamesReadBackAndUnknownOnesAreRefused) {
  Camera::Model model = Camera::Model::kEquidistant;
  EXPECT_TRUE(CameraModelFromName("radtan", &model));
  EXPECT_STREQ(CameraModelName(model), "plumb_bob");
  EXPECT_TRUE(CameraModelFromName("equidistant", &model));
  EXPECT_STREQ(CameraModelName(model), "equidistant");
  EXPECT_FALSE(CameraModelFromName("fisheye", &model));
}

}  // namespace
}  // namespace evit
