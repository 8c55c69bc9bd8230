#include "common/wire/place_wire.h"

#include <gtest/gtest.h>

#include "common/bus/codec.h"
#include "common/wire/geometry_wire.h"
#include "tests/helpers/sample_map_messages.h"

namespace evit {
namespace {

TEST(PlaceWire, AQueryComesBackAsItWas) {
  PlaceQuery query;
  query.number = 7;
  query.t = 123'456;
  query.surface = cv::Mat(10, 12, CV_8UC1);
  for (int k = 0; k < 120; ++k) query.surface.data[k] = static_cast<std::uint8_t>(2 * k);
  query.up_body = Eigen::Vector3d(0.1, 0.2, 0.97).normalized();
  query.everywhere = false;
  query.hypotheses = {SE3(ExpSO3({0.1, 0.2, 0.3}), {1, 2, 3}), SE3()};
  query.prior.near = {{1, 2, 0.5}, 1.5};
  query.prior.heading = {1, 0.2};
  Rig rig;
  rig.camera = FromMessage(Sample<place_query_t>().camera);
  rig.T_body_camera = SE3(ExpSO3({1, 0, 0}), {0.1, 0, 0});
  std::vector<std::uint8_t> bytes;
  EncodeTo(ToMessage(query, rig), &bytes);
  place_query_t message;
  std::string why;
  ASSERT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &message, &why)) << why;
  const PlaceQuery back = FromMessage(message);
  EXPECT_EQ(back.number, 7);
  EXPECT_EQ(back.t, 123'456);
  EXPECT_EQ(cv::countNonZero(back.surface != query.surface), 0);
  EXPECT_TRUE(back.up_body.isApprox(query.up_body));
  EXPECT_FALSE(back.everywhere);
  ASSERT_EQ(back.hypotheses.size(), 2U);
  EXPECT_EQ(back.hypotheses[0].p, query.hypotheses[0].p);
  EXPECT_LT(AngularDistance(back.hypotheses[0].q, query.hypotheses[0].q), 1e-9);
  ASSERT_TRUE(back.prior.near && back.prior.heading);
  EXPECT_FALSE(back.prior.height);
  EXPECT_EQ(back.prior.near->radius, 1.5);
  EXPECT_EQ(back.prior.heading->tolerance, 0.2);
  EXPECT_EQ(RigOf(message).T_body_camera.p, rig.T_body_camera.p);
  EXPECT_EQ(RigOf(message).camera.fx, rig.camera.fx);
}

TEST(PlaceWire, CandidatesComeBackAsTheyWere) {
  const std::vector<PlaceCandidate> places = {{SE3(ExpSO3({0, 0, 1}), {1, 2, 3}), 8.5, 20, 900}, {}};
  const std::vector<PlaceCandidate> back = PlacesOf(ToMessage(places));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].T_map_body.p, places[0].T_map_body.p);
  EXPECT_EQ(back[0].significance, 8.5);
  EXPECT_EQ(back[0].likeness, 20);
  EXPECT_EQ(back[0].n_points, 900);
}

}  // namespace
}  // namespace evit
