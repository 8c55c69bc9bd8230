#include "services/window_optimizer/request_client.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"

namespace evit {
namespace {

using std::chrono::milliseconds;
using Points = RequestClient<MapPointsRequest>;
using Views = RequestClient<MapViewRequest>;

map_query_t PointsQuery() {
  map_query_t query{};
  query.orientation[3] = 1;
  query.camera.model = "plumb_bob";
  query.camera.width = query.camera.height = 16;
  query.camera.fx = query.camera.fy = query.camera.cx = query.camera.cy = 8;
  query.min_depth = 0.1, query.max_depth = 10, query.max_points = 100;
  return query;
}

view_query_t ViewQueryMessage() {
  view_query_t query{};
  query.orientation[3] = 1;
  query.camera = PointsQuery().camera;
  query.min_depth = 0.1, query.max_depth = 10;
  return query;
}

class RequestClientTest : public ::testing::Test {
 protected:
  RequestClientTest() {
    test::Keep(server_.get(), channels_.map_query, &queries_);
    test::Keep(server_.get(), channels_.view_query, &view_queries_);
  }
  std::vector<map_query_t>& Queries() {
    server_->Poll(0);
    return queries_;
  }
  map_points_t AnswerTo(const map_query_t& query) {
    map_points_t answer{};
    answer.query_epoch = query.epoch;
    answer.query_seq = query.seq;
    return answer;
  }
  map_view_t ViewFor(const view_query_t& query, int width, int height) {
    map_view_t view{};
    view.query_epoch = query.epoch;
    view.query_seq = query.seq;
    view.width = width, view.height = height, view.size = width * height, view.min_depth = 0.1;
    view.log_intensity.assign(view.size, 0);
    view.inverse_depth.assign(view.size, 0);
    return view;
  }
  template <typename Client, typename Message>
  bool Give(Client* client, const Message& answer) {
    std::vector<std::uint8_t> bytes;
    EncodeTo(answer, &bytes);
    return client->OnAnswer(bytes.data(), bytes.size(), now_);
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_), server_ = OpenMemoryBus(hub_);
  Channels channels_;
  StatusReporter status_{bus_.get(), channels_, "window_optimizer", 9};
  Points::Clock::time_point now_ = Points::Clock::now();
  Points client_{bus_.get(), channels_, &status_, {milliseconds(20), milliseconds(60)}, now_};
  std::vector<map_query_t> queries_;
  std::vector<view_query_t> view_queries_;
};

TEST_F(RequestClientTest, AnAnswerIsTakenOnce) {
  client_.Ask(PointsQuery(), now_);
  ASSERT_EQ(Queries().size(), 1U);
  EXPECT_EQ(queries_[0].epoch, 9);
  EXPECT_FALSE(client_.answered());
  EXPECT_TRUE(Give(&client_, AnswerTo(queries_.at(0))));
  EXPECT_TRUE(client_.answered());
  EXPECT_TRUE(client_.TakeAnswer().has_value());
  EXPECT_FALSE(client_.TakeAnswer().has_value());
  EXPECT_TRUE(client_.answered());
  EXPECT_EQ(status_.Counter("MAP_POINTS.received"), 1);
}

TEST_F(RequestClientTest, OnlyTheAnswerToTheNewestQuestionCounts) {
  client_.Ask(PointsQuery(), now_);
  client_.Ask(PointsQuery(), now_);
  ASSERT_EQ(Queries().size(), 2U);
  EXPECT_FALSE(Give(&client_, AnswerTo(queries_.at(0))));
  map_points_t elsewhere = AnswerTo(queries_.at(1));
  elsewhere.query_epoch = 8;
  EXPECT_FALSE(Give(&client_, elsewhere));
  EXPECT_FALSE(client_.answered());
  EXPECT_TRUE(Give(&client_, AnswerTo(queries_.at(1))));
  EXPECT_FALSE(Give(&client_, AnswerTo(queries_.at(1))));  // twice
}

TEST_F(RequestClientTest, ANewQuestionDropsTheAnswerThatNobodyTook) {
  client_.Ask(PointsQuery(), now_);
  Give(&client_, AnswerTo(Queries().at(0)));
  client_.Ask(PointsQuery(), now_);
  EXPECT_FALSE(client_.TakeAnswer().has_value());
}

TEST_F(RequestClientTest, TheVerySameQuestionIsSentAgainUntilItIsAnswered) {
  client_.Ask(PointsQuery(), now_);
  client_.Tick(now_ += Points::kAskAgain);
  EXPECT_EQ(Queries().size(), 1U);
  client_.Tick(now_ += milliseconds(1));
  client_.Tick(now_ += milliseconds(1));
  ASSERT_EQ(Queries().size(), 2U);
  EXPECT_EQ(queries_[1].seq, queries_[0].seq);
  client_.Tick(now_ += Points::kAskAgain);
  EXPECT_EQ(Queries().size(), 3U);
  EXPECT_EQ(status_.Counter("MAP_QUERY.sent_again"), 2);
  Give(&client_, AnswerTo(queries_.at(0)));
  client_.Tick(now_ += 2 * Points::kAskAgain);
  EXPECT_EQ(Queries().size(), 3U);
}

TEST_F(RequestClientTest, AnAnswerIsNotWorthWaitingForLongerThanPatienceLasts) {
  client_.Ask(PointsQuery(), now_);
  EXPECT_FALSE(client_.GivenUp(now_ + milliseconds(20)));
  EXPECT_TRUE(client_.GivenUp(now_ + milliseconds(21)));
  Give(&client_, AnswerTo(Queries().at(0)));
  EXPECT_FALSE(client_.GivenUp(now_ + milliseconds(21)));
}

TEST_F(RequestClientTest, AServerThatStaysSilentIsNotWaitedForAtEachQuestion) {
  for (int k = 0; k < 4; ++k) client_.Ask(PointsQuery(), now_ += milliseconds(19));
  EXPECT_TRUE(client_.GivenUp(now_));
  Give(&client_, AnswerTo(Queries().at(0)));  // late, but it lives
  EXPECT_FALSE(client_.GivenUp(now_));
}

TEST_F(RequestClientTest, SaysWhenNobodyAnswers) {
  client_.Ask(PointsQuery(), now_);
  client_.Tick(now_ + Points::kNoServer);
  EXPECT_FALSE(client_.ServerTimedOut(now_ + Points::kNoServer));
  EXPECT_TRUE(client_.ServerTimedOut(now_ + Points::kNoServer + milliseconds(1)));
}

TEST_F(RequestClientTest, RubbishIsCounted) {
  client_.Ask(PointsQuery(), now_);
  const std::vector<std::uint8_t> rubbish(300, 0xab);
  EXPECT_FALSE(client_.OnAnswer(rubbish.data(), rubbish.size(), now_));
  EXPECT_FALSE(client_.answered());
  EXPECT_EQ(status_.Counter("MAP_POINTS.invalid"), 1);
}

TEST_F(RequestClientTest, AViewOfAnotherSizeIsNoAnswer) {
  Views views(bus_.get(), channels_, &status_, {milliseconds(50)}, now_);
  views.Ask(ViewQueryMessage(), now_);
  server_->Poll(0);
  ASSERT_EQ(view_queries_.size(), 1U);
  EXPECT_FALSE(Give(&views, ViewFor(view_queries_[0], 2, 2)));
  EXPECT_FALSE(views.answered());
  EXPECT_EQ(status_.Counter("MAP_VIEW.invalid"), 1);
  EXPECT_TRUE(Give(&views, ViewFor(view_queries_[0], 16, 16)));
  EXPECT_TRUE(views.answered());
}

}  // namespace
}  // namespace evit
