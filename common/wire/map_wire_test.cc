#include "common/wire/map_wire.h"

#include <gtest/gtest.h>

#include "common/bus/codec.h"
#include "common/wire/geometry_wire.h"

namespace evit {
namespace {

VisibilityQuery Query() {
  VisibilityQuery q;
  q.T_map_camera = {ExpSO3({0.4, -0.9, 1.3}), {1, -2, 0.5}};
  q.camera.model = Camera::Model::kEquidistant;
  q.camera.width = 640, q.camera.height = 480;
  q.camera.fx = 327, q.camera.fy = 328, q.camera.cx = 304, q.camera.cy = 235;
  q.camera.distortion = {-0.03, 0.01, 0.002, -0.001, 0};
  q.margin_px = 30, q.min_depth = 0.2, q.max_depth = 8, q.max_points = 700, q.seed = 99;
  q.occlusion = true;
  return q;
}

TEST(MapWire, AQueryComesBackAsItWas) {
  const VisibilityQuery q = Query();
  std::vector<std::uint8_t> bytes;
  EncodeTo(ToMessage(q), &bytes);
  map_query_t m;
  std::string why;
  ASSERT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &m, &why)) << why;
  const VisibilityQuery back = FromMessage(m);
  EXPECT_EQ(back.T_map_camera.p, q.T_map_camera.p);
  EXPECT_LT(back.T_map_camera.q.angularDistance(q.T_map_camera.q), 1e-15);
  EXPECT_EQ(back.camera.model, q.camera.model);
  EXPECT_EQ(back.camera.distortion, q.camera.distortion);
  EXPECT_EQ(std::vector<double>({back.camera.fx, back.camera.fy, back.camera.cx, back.camera.cy}),
            std::vector<double>({327, 328, 304, 235}));
  EXPECT_EQ(back.camera.width, 640);
  EXPECT_EQ(back.camera.height, 480);
  EXPECT_EQ(back.margin_px, q.margin_px);
  EXPECT_EQ(back.min_depth, q.min_depth);
  EXPECT_EQ(back.max_depth, q.max_depth);
  EXPECT_EQ(back.max_points, q.max_points);
  EXPECT_EQ(back.seed, q.seed);
  EXPECT_TRUE(back.occlusion);
}

TEST(MapWire, AnAnswerHoldsThePointsItIndexes) {
  PointMap map;
  map.points = {{0, 0, 1}, {1, 2, 3}, {4, 5, 6}};
  VisibilityAnswer answer;
  answer.n_visible = 3;
  answer.ids = {2, 1};
  const map_points_t m = ToMessage(answer, map);
  EXPECT_EQ(m.map_size, 3);
  EXPECT_EQ(m.n_visible, 3);
  EXPECT_EQ(m.n, 2);
  EXPECT_EQ(PointsOf(m), (std::vector<Eigen::Vector3f>{map.points[2], map.points[1]}));
}

}  // namespace
}  // namespace evit
