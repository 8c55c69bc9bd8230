#include "common/localization/place_finder.h"

#include <gtest/gtest.h>

#include "tests/helpers/synthetic_room.h"

namespace evit {
namespace {

PlaceQuery QueryFrom(const PointMap& map, const SE3& T_map_body) {
  PlaceQuery query;
  query.number = 1;
  query.surface = synthetic::SeenFrom(map, T_map_body);
  query.up_body = T_map_body.q.conjugate() * Eigen::Vector3d::UnitZ();
  return query;
}

void ExpectNear(const SE3& a, const SE3& b) {
  EXPECT_LT((a.p - b.p).norm(), 0.03);
  EXPECT_LT(AngularDistance(a.q, b.q), 0.02);
}

const SE3 kHere(ExpSO3({0, 0, 2.1}) * ExpSO3({0.05, 0.1, 0}), {0.4, -0.6, 0.2});

TEST(PlaceFinder, FindsWhereAKeyframeWasSeen) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const PointMap& map = room.index.map();
  PlaceQuery query = QueryFrom(map, kHere);
  query.up_body = ExpSO3({0.03, -0.04, 0}) * query.up_body;  // as accelerometers have it
  const std::vector<PlaceCandidate> places = room.finder.Answer(query);
  ASSERT_GE(places.size(), 2U);
  ExpectNear(places[0].T_map_body, kHere);
  EXPECT_GT(places[0].significance, 6);
  EXPECT_LT(places[1].significance, 5);
}

TEST(PlaceFinder, TheNumberOfThreadsChangesNothing) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const PointMap& map = room.index.map();
  PlaceFinderOptions alone;
  alone.threads = 1;
  const PlaceFinder finder(room.index, room.places, synthetic::IndexedRoom::TestRig(), {}, {}, alone);
  const auto a = finder.Answer(QueryFrom(map, kHere)), b = room.finder.Answer(QueryFrom(map, kHere));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].T_map_body.p, b[k].T_map_body.p);
    EXPECT_EQ(a[k].significance, b[k].significance);
  }
}

TEST(PlaceFinder, InAnotherRoomNothingIsSignificant) {
  const PlaceQuery query = QueryFrom(synthetic::TheRoom().index.map(), kHere);
  for (const PlaceCandidate& place : synthetic::OtherRoom().finder.Answer(query))
    EXPECT_LT(place.significance, 5.5);
}

TEST(PlaceFinder, ARoomThatLooksTheSameBothWaysHasTwoAnswers) {
  const synthetic::IndexedRoom& room = synthetic::TwoSidedRoom();
  const PointMap& map = room.index.map();
  const std::vector<PlaceCandidate> places = room.finder.Answer(QueryFrom(map, kHere));
  ASSERT_GE(places.size(), 2U);
  EXPECT_GT(places[1].significance, 0.9 * places[0].significance);
  const SE3 turned = SE3(ExpSO3({0, 0, EIGEN_PI}), Eigen::Vector3d::Zero()) * kHere;
  const bool first_is_here = (places[0].T_map_body.p - kHere.p).norm() < 0.1;
  ExpectNear(places[0].T_map_body, first_is_here ? kHere : turned);
  ExpectNear(places[1].T_map_body, first_is_here ? turned : kHere);
}

TEST(PlaceFinder, WithAPlaceThatFitsItNamesAllThatLookLikeIt) {
  const synthetic::IndexedRoom& room = synthetic::FourSidedRoom();
  const PointMap& map = room.index.map();
  PlaceQuery query = QueryFrom(map, kHere);
  query.hypotheses = {kHere};
  const std::vector<PlaceCandidate> places = room.finder.Answer(query);
  ExpectNear(places.at(0).T_map_body, kHere);
  for (const double quarter : {1, 2, 3}) {
    const SE3 turned =
        SE3(ExpSO3(Eigen::Vector3d(0, 0, quarter * EIGEN_PI / 2)), Eigen::Vector3d::Zero()) * kHere;
    EXPECT_TRUE(std::any_of(places.begin() + 1, places.end(), [&](const PlaceCandidate& place) {
      return (place.T_map_body.p - turned.p).norm() < 0.05 &&
             place.significance > 0.8 * places[0].significance;
    }));
  }
}

TEST(PlaceFinder, WhatIsKnownRulesTheOthersOut) {
  const synthetic::IndexedRoom& room = synthetic::TwoSidedRoom();
  const PointMap& map = room.index.map();
  PlaceQuery query = QueryFrom(map, kHere);
  query.prior.near = {kHere.p + Eigen::Vector3d(0.2, 0.1, 0), 0.4};
  const std::vector<PlaceCandidate> places = room.finder.Answer(query);
  ASSERT_FALSE(places.empty());
  ExpectNear(places[0].T_map_body, kHere);
  for (const PlaceCandidate& place : places) EXPECT_LT((place.T_map_body.p - kHere.p).norm(), 1.5);
}

TEST(PlaceFinder, HypothesesAreRefinedInTheirOrder) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const PointMap& map = room.index.map();
  PlaceQuery query = QueryFrom(map, kHere);
  query.everywhere = false;
  const SE3 away(ExpSO3({0, 0, -1}), {-0.5, 0.5, 0}),
      near = kHere.Plus((Vector6d() << 0.03, 0, 0.02, 0, 0.02, 0).finished());
  query.hypotheses = {away, near};
  const std::vector<PlaceCandidate> places = room.finder.Answer(query);
  ASSERT_GE(places.size(), 2U);
  EXPECT_LT((places[0].T_map_body.p - away.p).norm(), 0.4);
  ExpectNear(places[1].T_map_body, kHere);
  EXPECT_GT(places[1].significance, places[0].significance + 2);
}

TEST(PlaceFinder, AnEmptyViewOrAnEmptyMapHasNoAnswer) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const synthetic::IndexedRoom nothing({});
  PlaceQuery query = QueryFrom(room.index.map(), kHere);
  EXPECT_TRUE(nothing.finder.Answer(query).empty());
  query.surface.setTo(255);
  EXPECT_TRUE(room.finder.Answer(query).empty());
}

TEST(PlaceIndex, NoMorePlacesThanAllowedAndItCanBeStopped) {
  PlaceIndexOptions options = synthetic::IndexedRoom::Options();
  options.grid.max_places = 200;
  const PlaceIndex index(synthetic::WalledRoom(1), options);
  EXPECT_LE(index.places().size(), 200U);
  EXPECT_GT(index.places().size(), 50U);
  EXPECT_GT(index.spacing(), 0.35);
  EXPECT_THROW(
      PlaceIndex(synthetic::WalledRoom(1), options, [](double) { throw std::runtime_error("stop"); }),
      std::runtime_error);
}

}  // namespace
}  // namespace evit
