#include "common/wire/view_wire.h"

#include <gtest/gtest.h>

#include "common/bus/codec.h"

namespace evit {
namespace {

PhotometricView MakeView() {
  PhotometricView view;
  view.query.T_map_camera = {ExpSO3({0.4, -0.9, 1.3}), {1, -2, 0.5}};
  Camera& camera = view.query.camera;
  camera.width = 320, camera.height = 240, camera.fx = 150, camera.fy = 151, camera.cx = 158, camera.cy = 119;
  for (int k = 0; k < 320 * 240; ++k) {
    view.log_intensity.push_back(-5 + 5.1F * static_cast<float>(k % 977) / 977);
    view.inverse_depth.push_back(k % 10 == 0 ? 0 : 0.1F + 8 * static_cast<float>(k % 1013) / 1013);
  }
  return view;
}

TEST(ViewWire, AViewComesBackAsNearAsPromisedAndFitsTheBus) {
  const PhotometricView view = MakeView();
  const map_view_t message = ToMessage(view);
  std::vector<std::uint8_t> bytes;
  EncodeTo(message, &bytes);
  EXPECT_LT(bytes.size(), 310'000u);
  map_view_t decoded;
  std::string why;
  ASSERT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &decoded, &why)) << why;
  const PhotometricView back = FromMessage(decoded, view.query);
  ASSERT_EQ(back.log_intensity.size(), view.log_intensity.size());
  ASSERT_EQ(back.inverse_depth.size(), view.inverse_depth.size());
  for (std::size_t k = 0; k < view.log_intensity.size(); ++k) {
    ASSERT_NEAR(back.log_intensity[k], view.log_intensity[k], 1.3e-4);
    ASSERT_NEAR(back.inverse_depth[k], view.inverse_depth[k], 0.9e-4);
    ASSERT_EQ(back.inverse_depth[k] > 0, view.inverse_depth[k] > 0);
  }
}

TEST(ViewWire, NothingSeenIsNotNear) {
  PhotometricView view = MakeView();
  view.inverse_depth[1] = 1e-9F;  // far, but seen
  view.inverse_depth[2] = 1e9F;   // nearer than min_depth
  view.log_intensity[1] = -1e9F;
  const PhotometricView back = FromMessage(ToMessage(view), view.query);
  EXPECT_GT(back.inverse_depth[1], 0);
  EXPECT_NEAR(back.inverse_depth[2], 10, 1e-3);
  EXPECT_EQ(back.log_intensity[1], -8);
}

TEST(ViewWire, AQueryComesBack) {
  const ViewQuery query = MakeView().query;
  std::vector<std::uint8_t> bytes;
  EncodeTo(ToMessage(query), &bytes);
  view_query_t decoded;
  std::string why;
  ASSERT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &decoded, &why)) << why;
  const ViewQuery back = FromMessage(decoded);
  EXPECT_EQ(back.T_map_camera.p, query.T_map_camera.p);
  EXPECT_LT(AngularDistance(back.T_map_camera.q, query.T_map_camera.q), 1e-7);
  EXPECT_EQ(back.camera.fy, 151);
  EXPECT_EQ(back.camera.cx, 158);
  EXPECT_EQ(back.camera.width, 320);
  EXPECT_EQ(back.max_depth, query.max_depth);
}

}  // namespace
}  // namespace evit
