#include "services/map_server/map_server.h"

#include <gtest/gtest.h>

#include <random>

#include "common/bus/memory_bus.h"
#include "tests/helpers/map_asker.h"

namespace evit {
namespace {

class MapServerTest : public ::testing::Test {
 protected:
  MapServerTest()
      : hub_(MakeMemoryHub()),
        bus_(OpenMemoryBus(hub_)),
        other_(OpenMemoryBus(hub_)),
        asker_(other_.get()),
        map_(test::Room(30'000, {3, 2.5F, 1.4F}, 1)),
        server_(bus_.get(), Channels(), MapIndex(map_), "a room") {}

  void Exchange() {
    bus_->Poll(0);
    server_.Tick();
    other_->Poll(0);
  }
  std::int64_t Counter(const std::string& name) {
    server_.Stop();  // sends STATUS, the first time
    other_->Poll(0);
    return asker_.counters.at(name);
  }

  std::shared_ptr<MemoryHub> hub_;
  std::unique_ptr<Bus> bus_, other_;
  test::Asker asker_;
  PointMap map_;
  MapServer server_;
};

TEST_F(MapServerTest, AnswersAsTheLibraryDoes) {
  asker_.Send(test::QueryMessage(3));
  Exchange();
  ASSERT_EQ(asker_.answers.size(), 1u);
  const map_points_t& m = asker_.answers[0];
  const VisibilityAnswer expected = MapIndex(map_).Query(test::LibraryQuery());
  EXPECT_EQ(m.id, expected.ids);
  EXPECT_EQ(m.n, 700);
  EXPECT_EQ(m.n_visible, expected.n_visible);
  EXPECT_GT(m.n_visible, 700);
  EXPECT_EQ(m.map_size, 30'000);
  EXPECT_EQ(m.utime, 1'000'003);
  EXPECT_EQ(m.query_seq, 3);
  EXPECT_EQ(m.query_epoch, 5);
  for (int k = 0; k < m.n; ++k) {
    EXPECT_EQ(Eigen::Vector3f(m.x[k], m.y[k], m.z[k]), map_.points[m.id[k]]);
  }
}

TEST_F(MapServerTest, SameQuerySameAnswerEvenOfAnotherServer) {
  asker_.Send(test::QueryMessage(3));
  Exchange();
  asker_.Send(test::QueryMessage(4));
  asker_.Send(test::QueryMessage(3));
  Exchange();
  MapServer second(bus_.get(), Channels("second/"), MapIndex(map_), "the same room");
  test::Asker other_asker(other_.get(), "second/");
  other_asker.Send(test::QueryMessage(3));
  bus_->Poll(0);
  second.Tick();
  other_->Poll(0);
  ASSERT_EQ(asker_.answers.size(), 3u);
  ASSERT_EQ(other_asker.answers.size(), 1u);
  for (const map_points_t& m : asker_.answers) EXPECT_EQ(m.id, other_asker.answers[0].id);
  EXPECT_EQ(asker_.answers[2].seq, 2);
  EXPECT_EQ(Counter("MAP_QUERY.duplicate"), 1);
  EXPECT_EQ(Counter("MAP_QUERY.received"), 2);
}

TEST_F(MapServerTest, MovedPointsAreAnotherMap) {
  PointMap moved = map_;
  moved.points[100].x() += 0.01F;
  MapServer same(bus_.get(), Channels("same/"), MapIndex(map_), "the same room"),
      other(bus_.get(), Channels("other/"), MapIndex(moved), "another room");
  test::Asker same_asker(other_.get(), "same/"), other_asker(other_.get(), "other/");
  for (test::Asker* asker : {&asker_, &same_asker, &other_asker}) asker->Send(test::QueryMessage(3));
  bus_->Poll(0);
  for (MapServer* server : {&server_, &same, &other}) server->Tick();
  other_->Poll(0);
  EXPECT_EQ(same_asker.answers.at(0).map_id, asker_.answers.at(0).map_id);
  EXPECT_NE(other_asker.answers.at(0).map_id, asker_.answers.at(0).map_id);
}

TEST_F(MapServerTest, LooksAwayAndSaysSo) {
  map_query_t m = test::QueryMessage(0);
  m.position[0] = 1000;
  asker_.Send(m);
  Exchange();
  ASSERT_EQ(asker_.answers.size(), 1u);  // nothing in view is an answer, too
  EXPECT_EQ(asker_.answers[0].n, 0);
  EXPECT_EQ(asker_.answers[0].n_visible, 0);
}

TEST_F(MapServerTest, AbsurdQueriesAreCountedNotAnswered) {
  int sent = 0;
  for (const auto& [name, query] : test::AbsurdQueries()) {
    asker_.Send(query);
    Exchange();
    EXPECT_TRUE(asker_.answers.empty()) << name;
    ++sent;
  }
  EXPECT_EQ(Counter("MAP_QUERY.invalid"), sent);
  EXPECT_EQ(Counter("MAP_QUERY.received"), 0);
}

TEST_F(MapServerTest, RubbishAndMutatedQueriesDoNoHarm) {
  std::vector<std::uint8_t> good;
  EncodeTo(test::QueryMessage(0), &good);
  std::mt19937 random(1);
  for (int k = 0; k < 2000; ++k) {
    std::vector<std::uint8_t> bytes = good;
    for (unsigned i = 0; i <= random() % 3; ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (k % 4 == 0) bytes.resize(random() % bytes.size());
    asker_.SendRaw(bytes);
    if (k % 50 == 0) Exchange();
  }
  Exchange();
  asker_.answers.clear();
  asker_.Send(test::QueryMessage(1));
  Exchange();
  ASSERT_EQ(asker_.answers.size(), 1u);
  EXPECT_EQ(asker_.answers[0].id, MapIndex(map_).Query(test::LibraryQuery()).ids);
  EXPECT_GT(Counter("MAP_QUERY.invalid"), 500);
}

TEST_F(MapServerTest, AFloodKeepsTheNewest) {
  for (int k = 0; k < 500; ++k) asker_.Send(test::QueryMessage(k));
  Exchange();
  ASSERT_EQ(asker_.answers.size(), 64u);
  EXPECT_EQ(asker_.answers.front().query_seq, 436);
  EXPECT_EQ(asker_.answers.back().query_seq, 499);
  EXPECT_EQ(Counter("MAP_QUERY.dropped"), 436);
}

TEST_F(MapServerTest, StatusTellsOfTheMap) {
  asker_.Send(test::QueryMessage(0));
  Exchange();
  EXPECT_EQ(asker_.state, "running");
  EXPECT_EQ(asker_.detail, "a room");
  EXPECT_EQ(Counter("map.points"), 30'000);
  EXPECT_GT(asker_.timings.at("query"), 0);
  EXPECT_EQ(asker_.state, "finished");
}

}  // namespace
}  // namespace evit
