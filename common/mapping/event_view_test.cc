#include "common/mapping/event_view.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/mapping/map_builder.h"
#include "tests/helpers/painted_events.h"

namespace evit {
namespace {

constexpr Utime kStep = 1'000;  // us, from pose to pose: a third of a pixel
constexpr int kSlice = 12;      // poses a view lasts

Camera EventCamera() {
  Camera camera;
  camera.width = 200, camera.height = 150;
  camera.fx = camera.fy = 150;
  camera.cx = 100, camera.cy = 75;
  return camera;
}

// One round of a camera on a circle, and its events.
class EventViewTest : public testing::Test {
 protected:
  static const std::vector<SE3>& Poses() {
    static const auto poses = CircleOfPoses(216, 0.16);
    return poses;
  }
  static const EventArray& Events() {
    static const auto events = PaintedEvents(PaintedScene::Wall(), EventCamera(), Poses(), 0, kStep);
    return events;
  }

  /// Views of the whole round, as if all events came `late` us after they do.
  static std::vector<PosedEdges> Views(Utime late) {
    const EventView maker(EventCamera(), {});
    std::vector<PosedEdges> views;
    for (std::size_t first = 0; first + kSlice < Poses().size(); first += kSlice) {
      EventSlice slice;
      slice.begin = static_cast<Utime>(first) * kStep;
      slice.end = slice.begin + kSlice * kStep;
      slice.T_map_camera.assign(Poses().begin() + static_cast<std::ptrdiff_t>(first),
                                Poses().begin() + static_cast<std::ptrdiff_t>(first + kSlice + 1));
      for (std::size_t k = 0; k < Events().size(); ++k) {
        const Utime t = Events().t[k] + late;
        if (t >= slice.begin && t < slice.end)
          slice.events.push_back(t, Events().x[k], Events().y[k], Events().p[k]);
      }
      views.push_back(maker.Make(slice, 2));
    }
    return views;
  }
};

TEST_F(EventViewTest, EdgesLieWhereTheSceneHasThem) {
  const PaintedScene scene = PaintedScene::Wall();
  int n = 0, near = 0;
  for (const PosedEdges& view : Views(0)) {
    const PinholeView pinhole(view.T_map_camera, view.camera);
    for (const EdgePixel& edge : view.edges.edges()) {
      // On the wall, 2 m ahead; what belongs to the board before it is not asked.
      const Eigen::Vector3d ray((edge.pixel.x() - view.camera.cx) / view.camera.fx,
                                (edge.pixel.y() - view.camera.cy) / view.camera.fy, 1);
      const Eigen::Vector3d on_wall = view.T_map_camera * (1.999 * ray);
      if (std::abs(on_wall.x()) < 0.35 && std::abs(on_wall.z()) < 0.4) continue;
      ++n;
      near += scene.DistanceToEdge(on_wall) < 0.013 ? 1 : 0;  // a pixel
    }
  }
  ASSERT_GT(n, 1000);
  EXPECT_GT(near, 0.9 * n);
}

TEST_F(EventViewTest, NormalsPointToTheBrighterSide) {
  const PaintedScene scene = PaintedScene::Wall();
  int n = 0, right = 0;
  for (const PosedEdges& view : Views(0)) {
    for (const EdgePixel& edge : view.edges.edges()) {
      const auto grey = [&](float off) {
        const Eigen::Vector2f at = edge.pixel + off * edge.normal;
        const Eigen::Vector3d ray((at.x() - view.camera.cx) / view.camera.fx,
                                  (at.y() - view.camera.cy) / view.camera.fy, 1);
        return scene.Grey(view.T_map_camera.p, view.T_map_camera.q * ray);
      };
      ++n;
      right += grey(1.5F) > grey(-1.5F) ? 1 : 0;
    }
  }
  ASSERT_GT(n, 1000);
  EXPECT_GT(right, 0.9 * n);
}

TEST_F(EventViewTest, HowLateEventsComeIsFound) {
  const MapBuilderOptions options = OptionsForEvents({});
  std::vector<PosedEdges> views = Views(0), late_views = Views(2 * kStep);
  const double before = TakeOutLag(2, options, &views), later = TakeOutLag(2, options, &late_views);
  // Two steps of a circle of 0.16 m, seen from 2 m.
  EXPECT_NEAR(later - before, 2 * 2 * M_PI * 0.16 / 216 / 2 * 150, 0.15);
}

TEST_F(EventViewTest, AMapOfThemLiesOnTheEdgesOfTheScene) {
  std::vector<PosedEdges> views = Views(2 * kStep);
  MapBuilderOptions options = OptionsForEvents({});
  options.typical_depth_m = SceneDepth(views, options);
  ASSERT_NEAR(options.typical_depth_m, 2, 0.3);
  TakeOutLag(options.typical_depth_m, options, &views);
  const BuiltMap map = BuildMap(views, options, [](double, const std::string&) {});
  ASSERT_GT(map.points.size(), 300U);
  const PaintedScene scene = PaintedScene::Wall();
  std::vector<double> errors;
  for (const MappedPoint& p : map.points) {
    errors.push_back(scene.DistanceToEdge(p.position));
    EXPECT_EQ(p.contrast, 0);
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.01);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.05);
}

TEST_F(EventViewTest, ACameraThatRestsOrSeesNothingShowsNoEdges) {
  EventSlice slice;
  slice.end = 1000;
  slice.T_map_camera.assign(3, Poses()[0]);
  for (int k = 0; k < 2000; ++k)
    slice.events.push_back(k / 2, static_cast<std::uint16_t>(50 + k % 100), 70, 1);  // a lamp that flickers
  EXPECT_TRUE(EventView(EventCamera(), {}).Make(slice, 2).edges.edges().empty());
}

}  // namespace
}  // namespace evit
