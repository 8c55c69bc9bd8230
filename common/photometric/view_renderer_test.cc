#include "common/photometric/view_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/helpers/photometric_room.h"

namespace evit {
namespace {

const SE3 kPoses[] = {
    {},
    {ExpSO3({0.5, 0.1, -0.2}), {0.3, 0.2, -0.1}},  // 30 degrees of roll
    {ExpSO3({1.57, 0, 0}), {-0.4, -0.3, 0.2}},     // 90
    {ExpSO3({0, -0.2, -0.6}), {0.5, 0.1, 0.3}},    // towards the nearer wall
};

ViewQuery QueryAt(const SE3& T_map_body) {
  ViewQuery query;
  query.camera = ViewCamera(test::EventCamera(640, 480), 0.08);
  query.T_map_camera = T_map_body * test::BodyCamera();
  return query;
}

// Against a cast ray for each pixel.
TEST(ViewRenderer, SeesWhatRaysSee) {
  const test::Room room;
  ViewRenderer renderer(room.Map(0.01), test::Room::kDark);
  EXPECT_NEAR(renderer.spacing(), 0.01, 1e-3);
  for (const SE3& pose : kPoses) {
    const ViewQuery query = QueryAt(pose);
    PhotometricView view;
    renderer.Render(query, &view);
    const PhotometricView truth = room.See(query.camera, query.T_map_camera);
    const auto n = static_cast<int>(view.log_intensity.size());
    int seen = 0, same_depth = 0;
    std::vector<double> errors, slopes, slope_errors;
    for (int k = 1; k + 1 < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (!(truth.inverse_depth[i] > 0)) continue;
      ++seen;
      if (!(std::abs(view.inverse_depth[i] - truth.inverse_depth[i]) < 0.01 * truth.inverse_depth[i]))
        continue;
      ++same_depth;
      errors.push_back(std::abs(view.log_intensity[i] - truth.log_intensity[i]));
      const auto slope = [&](const PhotometricView& v) {
        return 0.5 * (v.log_intensity[i + 1] - v.log_intensity[i - 1]);
      };
      slopes.push_back(std::abs(slope(truth)));
      slope_errors.push_back(std::abs(slope(view) - slope(truth)));
    }
    const auto mean = [](const std::vector<double>& v) {
      double sum = 0;
      for (const double x : v) sum += x;
      return sum / static_cast<double>(v.size());
    };
    ASSERT_GT(seen, 50'000);
    EXPECT_GT(same_depth, 0.985 * seen);
    EXPECT_LT(mean(errors), 0.03);
    EXPECT_LT(mean(slope_errors), 0.12 * mean(slopes));
  }
}

TEST(ViewRenderer, NearerWallsHideFartherOnes) {
  PhotometricMap map;
  for (double y = -1; y < 1; y += 0.01) {
    for (double z = -1; z < 1; z += 0.01) {
      map.points.emplace_back(2, y, z), map.intensities.push_back(0.9F);
      if (std::abs(y) < 0.3) map.points.emplace_back(1, y, z), map.intensities.push_back(0.1F);
    }
  }
  ViewRenderer renderer(map);
  const ViewQuery query = QueryAt({Eigen::Quaterniond::Identity(), {-0.05, 0, 0}});
  PhotometricView view;
  renderer.Render(query, &view);
  int wrong = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const double across = -(x - query.camera.cx) / query.camera.fx;  // y of the map at 1 m
      if (std::abs(std::abs(across) - 0.3) < 0.03 || std::abs(across) > 0.45) continue;
      const double up = std::abs(y - query.camera.cy) / query.camera.fy;
      if (up > 0.45) continue;
      const bool near = std::abs(across) < 0.3;
      const auto k = static_cast<std::size_t>(320 * y + x);
      const float depth = 1 / view.inverse_depth[k], light = std::exp(view.log_intensity[k]);
      if (std::abs(depth - (near ? 1 : 2)) > 0.05 || std::abs(light - (near ? 0.112 : 0.912)) > 1e-3) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(ViewRenderer, NothingInViewIsNothing) {
  ViewRenderer renderer(test::Room().Map(0.05)), empty{PhotometricMap()};
  PhotometricView view;
  for (ViewRenderer* r : {&renderer, &empty}) {
    r->Render(QueryAt({Eigen::Quaterniond(0, 0, 0, 1), {0, 0, 0}}), &view);  // looks back
    ASSERT_EQ(view.inverse_depth.size(), 320u * 240u);
    EXPECT_TRUE(
        std::all_of(view.inverse_depth.begin(), view.inverse_depth.end(), [](float v) { return v == 0; }));
  }
}

TEST(ViewRenderer, DepthsOutsideTheRangeAreNotSeenAndTheSameQueryGivesTheSameBitsOnAnyThreads) {
  ViewRenderer renderer(test::Room().Map(0.02)), two_threads(test::Room().Map(0.02), ViewRenderer::kDark, 2);
  ViewQuery query = QueryAt({});
  PhotometricView first, second;
  renderer.Render(query, &first);
  query.max_depth = 2.5;
  renderer.Render(query, &second);
  EXPECT_GE(1.001 / 2.5, *std::min_element(first.inverse_depth.begin(), first.inverse_depth.end()));
  for (const float v : second.inverse_depth) EXPECT_TRUE(v == 0 || v > 0.999 / 2.5);
  query.max_depth = ViewQuery().max_depth;
  renderer.Render(query, &second);
  EXPECT_EQ(first.log_intensity, second.log_intensity);
  EXPECT_EQ(first.inverse_depth, second.inverse_depth);
  two_threads.Render(query, &second);
  EXPECT_EQ(first.log_intensity, second.log_intensity);
  EXPECT_EQ(first.inverse_depth, second.inverse_depth);
}

TEST(ViewCamera, LooksTheSameWayAndALittleWider) {
  const Camera camera = test::EventCamera(640, 480), view = ViewCamera(camera, 0.1);
  EXPECT_EQ(view.width, 320);
  EXPECT_EQ(view.height, 240);
  // The middle of the image stays, its corners come in by a tenth of the view.
  const auto pixel_of = [&](double x, double y) {  // of the view, of an undistorted pixel of the camera
    return Eigen::Vector2d((x - camera.cx) / camera.fx * view.fx + view.cx,
                           (y - camera.cy) / camera.fy * view.fy + view.cy);
  };
  EXPECT_LT((pixel_of(319.5, 239.5) - Eigen::Vector2d(159.5, 119.5)).norm(), 1e-9);
  EXPECT_LT((pixel_of(-0.5, -0.5) - Eigen::Vector2d(159.5 - 160 / 1.1, 119.5 - 120 / 1.1)).norm(), 1e-9);
}

}  // namespace
}  // namespace evit
