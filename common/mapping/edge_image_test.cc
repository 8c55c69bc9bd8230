#include "common/mapping/edge_image.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

// A vertical line at column 20.25, bright on the right.
EdgeImage Line(bool has_sides) {
  std::vector<EdgePixel> edges;
  for (int row = 10; row < 30; ++row) {
    EdgePixel e;
    e.pixel = {20.25F, static_cast<float>(row)};
    edges.push_back(e);
  }
  return {48, 40, edges, has_sides};
}

EdgeImage::Query At(float x, float y, float normal_x) {
  EdgeImage::Query query;
  query.pixel = {x, y};
  query.normal = {normal_x, 0};
  return query;
}

TEST(EdgeImage, MatchesTheNearestEdgeAcrossWithinTheRadius) {
  const EdgeImage image = Line(true);
  const EdgePixel* match = image.Match(At(21.9F, 17.2F, 1));
  ASSERT_NE(match, nullptr);
  EXPECT_EQ(match->pixel, Eigen::Vector2f(20.25F, 17));
  EXPECT_EQ(image.Match(At(22.5F, 17, 1)), nullptr);
  EXPECT_EQ(image.Match(At(20, 33, 1)), nullptr);
}

TEST(EdgeImage, TellsTheSidesApartOnlyWhereItKnowsThem) {
  EXPECT_EQ(Line(true).Match(At(20, 17, -1)), nullptr);
  EXPECT_NE(Line(false).Match(At(20, 17, -1)), nullptr);
  const int ahead = EdgeImage::BinOf({1, 0}), back = EdgeImage::BinOf({-1, 0});
  EXPECT_EQ(Line(true).Vote(20, 17, ahead), 2);
  EXPECT_EQ(Line(true).Vote(20, 17, back), 0);
  EXPECT_EQ(Line(false).Vote(20, 17, back), 2);
}

TEST(EdgeImage, VotesLessFartherAwayAndNotForOtherDirections) {
  const EdgeImage image = Line(true);
  EXPECT_EQ(image.Vote(21, 17, EdgeImage::BinOf({1, 0})), 2);
  EXPECT_EQ(image.Vote(19, 17, EdgeImage::BinOf({1, 0})), 1);
  EXPECT_EQ(image.Vote(23, 17, EdgeImage::BinOf({1, 0})), 0);
  EXPECT_EQ(image.Vote(20, 17, EdgeImage::BinOf({0, 1})), 0);
}

TEST(EdgeImage, AsksNothingOfPlacesFarOutside) {
  const EdgeImage image = Line(true);
  EXPECT_EQ(image.Match(At(-50, -50, 1)), nullptr);
  EXPECT_EQ(image.Match(At(500, 17, 1)), nullptr);
}

}  // namespace
}  // namespace evit
