#include "common/mapping/map_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/mapping/edge_detector.h"
#include "common/mapping/sensor_depth.h"
#include "tests/helpers/painted_scene.h"

namespace evit {
namespace {

Camera SmallCamera() {
  Camera camera;
  camera.width = 200, camera.height = 150;
  camera.fx = camera.fy = 150;
  camera.cx = 100, camera.cy = 75;
  return camera;
}

std::vector<PosedEdges> ViewsFrom(const std::vector<SE3>& poses) {
  const PaintedScene scene = PaintedScene::Wall();
  const Camera camera = SmallCamera();
  std::vector<PosedEdges> views;
  views.reserve(poses.size());
  for (const SE3& pose : poses) {
    views.push_back({pose, camera,
                     EdgeImage(camera.width, camera.height,
                               DetectEdges(scene.Picture(camera, pose), cv::Mat(), {}), true)});
  }
  return views;
}

BuiltMap Build(const std::vector<PosedEdges>& views, int threads = 2) {
  MapBuilderOptions options;
  options.threads = threads;
  return BuildMap(views, options, [](double, const std::string&) {});
}

std::vector<double> Errors(const BuiltMap& map) {
  const PaintedScene scene = PaintedScene::Wall();
  std::vector<double> errors;
  for (const MappedPoint& p : map.points) errors.push_back(scene.DistanceToEdge(p.position));
  std::sort(errors.begin(), errors.end());
  return errors;
}

// Share of the patches' sides, in steps of 1 cm, with a point within 1.5 cm.
double Coverage(const BuiltMap& map) {
  int n = 0, found = 0;
  const PaintedScene scene = PaintedScene::Wall();
  for (std::size_t k = 1; k < scene.rectangles().size();
       ++k) {  // the first is the wall, larger than the view
    const auto& r = scene.rectangles()[k];
    for (int side = 0; side < 4; ++side) {
      const Eigen::Vector3d along = side % 2 == 0 ? r.u : r.v;
      const Eigen::Vector3d from = side < 2 ? r.corner : Eigen::Vector3d(r.corner + (side == 2 ? r.v : r.u));
      for (double s = 0.02; s < along.norm() - 0.02; s += 0.01, ++n) {
        const Eigen::Vector3d at = from + s * along.normalized();
        found += std::any_of(map.points.begin(), map.points.end(),
                             [&](const MappedPoint& p) { return (p.position - at).norm() < 0.015; });
      }
    }
  }
  return static_cast<double>(found) / n;
}

class BuiltFromPictures : public testing::Test {
 protected:
  static const std::vector<PosedEdges>& Views() {
    static const auto views = ViewsFrom(PaintedScene::Poses(24, 0.4));
    return views;
  }
  static const BuiltMap& Map() {
    static const BuiltMap map = Build(Views());
    return map;
  }
};

TEST_F(BuiltFromPictures, LiesOnTheEdgesOfTheScene) {
  const std::vector<double> errors = Errors(Map());
  ASSERT_GT(errors.size(), 500U);
  EXPECT_LT(errors[errors.size() / 2], 0.003);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.02);
}

TEST_F(BuiltFromPictures, ShowsNearlyAllEdges) { EXPECT_GT(Coverage(Map()), 0.85); }

TEST_F(BuiltFromPictures, KnowsDirectionSigmaAndViews) {
  for (const MappedPoint& p : Map().points) {
    EXPECT_NEAR(p.direction.norm(), 1, 1e-6);
    EXPECT_GT(p.sigma, 0);
    EXPECT_GE(p.views, 5);
    EXPECT_LE(p.views, 24);
    EXPECT_GT(p.contrast, 0.1);
  }
  // Of the points on the wall nearly all run along x or z.
  int along = 0, n = 0;
  for (const MappedPoint& p : Map().points) {
    if (p.position.y() < 1.95) continue;
    ++n;
    along += std::max(std::abs(p.direction.x()), std::abs(p.direction.z())) > 0.95 ? 1 : 0;
  }
  EXPECT_GT(along, 0.85 * n);
}

TEST_F(BuiltFromPictures, DoesNotDependOnTheNumberOfThreads) {
  const BuiltMap other = Build(Views(), 1);
  ASSERT_EQ(other.points.size(), Map().points.size());
  for (std::size_t k = 0; k < other.points.size(); ++k)
    EXPECT_EQ(other.points[k].position, Map().points[k].position);
}

TEST_F(BuiltFromPictures, PutsRightWhatSinglePosesHaveWrong) {
  std::vector<PosedEdges> shaken = Views();
  for (std::size_t k = 0; k < shaken.size(); ++k) {
    Vector6d off;
    off << 0.002 * std::sin(7.0 * k), 0.002 * std::cos(5.0 * k), 0.002 * std::sin(3.0 * k + 1),
        0.002 * std::cos(4.0 * k), 0.002 * std::sin(6.0 * k), 0.002 * std::cos(8.0 * k + 2);
    shaken[k].T_map_camera = shaken[k].T_map_camera.Plus(off);
  }
  const BuiltMap map = Build(shaken);
  EXPECT_LT(map.adjustment.rms_after_px, 0.6 * map.adjustment.rms_before_px);
  const std::vector<double> errors = Errors(map);
  ASSERT_GT(errors.size(), 500U);
  // 2 mm and 0.1 degrees a view: what they have in common no view can tell.
  EXPECT_LT(errors[errors.size() / 2], 0.012);
}

TEST_F(BuiltFromPictures, IsEmptyOrRefusedWithTheWrongPoses) {
  std::vector<PosedEdges> mixed = Views();
  for (std::size_t k = 0; k < mixed.size(); ++k)
    mixed[k].T_map_camera = Views()[(7 * k + 3) % mixed.size()].T_map_camera;
  try {
    EXPECT_LT(Build(mixed).points.size(), Map().points.size() / 10);
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("poses"));
  }
}

// A wide wall, seen by a depth camera from 2 m: two views look at one patch, a third at another alone.
class BuiltFromDepths : public testing::Test {
 protected:
  static constexpr double kLeft = -1, kRight = 2.5;  // m along the wall, the middles of the patches

  static PaintedScene Wall(bool with_right) {
    PaintedScene scene;
    scene.Add({-5, 2, -3}, {10, 0, 0}, {0, 0, 6}, 120);
    scene.Add({kLeft - 0.3, 1.999, -0.2}, {0.6, 0, 0}, {0, 0, 0.4}, 30);
    if (with_right) scene.Add({kRight - 0.3, 1.999, -0.2}, {0.6, 0, 0}, {0, 0, 0.4}, 220);
    return scene;
  }
  void See(const PaintedScene& scene, double x) {
    const Camera camera = SmallCamera();
    const SE3 pose(PaintedScene::Poses(1, 0).front().q, {x, 0, 0});
    views_.push_back({pose, camera,
                      EdgeImage(camera.width, camera.height,
                                DetectEdges(scene.Picture(camera, pose), cv::Mat(), {}), true)});
    cv::Mat depth;
    scene.Depth(camera, pose, 1000).convertTo(depth, CV_32F, 1e-3);
    depths_.push_back({static_cast<int>(depths_.size()), DepthsFromImage(views_.back(), depth, {})});
  }
  // Points near the left and the right patch.
  std::pair<int, int> Points() const {
    const BuiltMap map = BuildMapFromDepths(views_, depths_, {}, [](double, const std::string&) {});
    std::pair<int, int> n;
    for (const MappedPoint& p : map.points) {
      EXPECT_LT(Wall(true).DistanceToEdge(p.position), 0.01);
      ++(p.position.x() < 0.5 * (kLeft + kRight) ? n.first : n.second);
    }
    return n;
  }

  std::vector<PosedEdges> views_;
  std::vector<KeyDepths> depths_;
};

TEST_F(BuiltFromDepths, ShowsWhatOneViewAloneLooksAt) {
  See(Wall(true), kLeft - 0.1);
  See(Wall(true), kLeft + 0.1);
  See(Wall(true), kRight);
  const auto [left, right] = Points();
  EXPECT_GT(left, 150);
  EXPECT_GT(right, 100);
}

TEST_F(BuiltFromDepths, LacksWhatAnotherViewLooksAtAndDoesNotShow) {
  See(Wall(true), kLeft - 0.1);
  See(Wall(true), kLeft + 0.1);
  See(Wall(true), kRight);
  See(Wall(false), kRight + 0.1);
  const auto [left, right] = Points();
  EXPECT_GT(left, 150);
  EXPECT_EQ(right, 0);
}

TEST(BuildMap, RefusesTwoViewsAndACameraThatOnlyTurns) {
  EXPECT_THROW(Build(ViewsFrom(PaintedScene::Poses(2, 0.2))), std::runtime_error);
  try {
    Build(ViewsFrom(PaintedScene::Poses(8, 0.0)));
    FAIL() << "no motion, no depth";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("baseline"));
  }
}

}  // namespace
}  // namespace evit
