#include "tools/simulation/image_map.h"

#include <gtest/gtest.h>

#include "tools/simulation/edge_pixels.h"
#include "tools/simulation/room.h"

namespace evit::simulation {
namespace {

class ImageMapTest : public ::testing::Test {
 protected:
  ImageMapTest() : scene_(MakeRoom(2, RoomKind::kFurnished)) {
    camera_.width = 320;
    camera_.height = 240;
    camera_.fx = camera_.fy = 160;
    camera_.cx = 159.5;
    camera_.cy = 119.5;
    Eigen::Matrix3d R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    pose_ = {Eigen::Quaterniond(R), {0, 0, 1.4}};
  }

  static ImageMapSettings Exact() {
    ImageMapSettings settings;
    settings.on = true;
    settings.scale = 1;
    settings.match_px = settings.missing_share = settings.parallel_deg = 0;
    settings.view_turn_deg = settings.view_move_m = settings.grey_noise = 0;
    return settings;
  }

  std::vector<Eigen::Vector3d> Points(const ImageMapSettings& settings, int view = 0) const {
    const Renderer renderer(ScaledCamera(camera_, settings.scale), scene_);
    return PointsOfImage(renderer, pose_, {0, 0.3, 0}, settings, 1, view);
  }

  // m: rms of how far points of `a` are from the same edge's of `b`, along the view.
  double DepthError(const ImageMapSettings& settings) const {
    const auto exact = Points(Exact()), points = Points(settings);
    double sum = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
      sum += std::pow((points[k] - pose_.p).norm() - (exact[k] - pose_.p).norm(), 2);
    return std::sqrt(sum / static_cast<double>(points.size()));
  }

  Scene scene_;
  Camera camera_;
  SE3 pose_;
};

TEST_F(ImageMapTest, WithoutErrorsPointsLieOnSurfaces) {
  const Renderer renderer(camera_, scene_);
  View view;
  renderer.Render(pose_, &view);
  int on = 0;
  const auto points = Points(Exact());
  ASSERT_GT(points.size(), 1000U);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d in_camera = pose_.Inverse() * p;
    Eigen::Vector2d pixel;
    ASSERT_TRUE(camera_.Project(in_camera, &pixel));
    const auto x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
    const double z = 1 / view.inverse_depth[static_cast<std::size_t>(y) * 320 + x];
    on += std::abs(z - in_camera.z()) < 0.05 * z ? 1 : 0;
  }
  EXPECT_GT(on, 0.85 * static_cast<double>(points.size()));
}

TEST_F(ImageMapTest, DepthErrsWithTheMatchOverTheBaseline) {
  ImageMapSettings settings = Exact();
  settings.match_px = 0.2;
  const double once = DepthError(settings);
  settings.baseline_m *= 2;
  EXPECT_NEAR(DepthError(settings), once / 2, 0.2 * once);
  EXPECT_GT(once, 0.005);
  EXPECT_LT(once, 0.1);
}

TEST_F(ImageMapTest, PiecesAreMissingInAllViewsAlike) {
  ImageMapSettings settings = Exact();
  settings.missing_share = 0.4;
  const std::size_t all = Points(Exact()).size(), kept = Points(settings).size();
  EXPECT_NEAR(static_cast<double>(kept), 0.6 * static_cast<double>(all), 0.1 * static_cast<double>(all));
  EXPECT_EQ(Points(settings, 7).size(), kept);
}

TEST_F(ImageMapTest, EdgesAlongTheMotionAreNotMatched) {
  ImageMapSettings settings = Exact();
  settings.parallel_deg = 45;
  const double share =
      static_cast<double>(Points(settings).size()) / static_cast<double>(Points(Exact()).size());
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.8);
}

TEST_F(ImageMapTest, ViewsThatErrPutAnEdgeTwice) {
  ImageMapSettings settings = Exact();
  settings.view_turn_deg = 0.2;
  settings.view_move_m = 0;
  const auto a = Points(settings, 0), b = Points(settings, 1);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT((a.front() - b.front()).norm(), 0.001);
}

}  // namespace
}  // namespace evit::simulation
