#include "services/map_server/view_server.h"

#include <gtest/gtest.h>

#include "common/bus/codec.h"
#include "common/bus/memory_bus.h"
#include "common/wire/view_wire.h"
#include "services/map_server/map_server.h"
#include "tests/helpers/photometric_room.h"

namespace evit {
namespace {

class ViewServerTest : public ::testing::Test {
 protected:
  ViewServerTest() : server_(bus_.get(), Channels(), MapIndex({}), "a photometric room") {
    server_.ServeViews(map_);
    other_->Subscribe(Channels().map_view,
                      [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                        map_view_t m;
                        std::string why;
                        ASSERT_TRUE(DecodeChecked(data, size, &m, &why)) << why;
                        answers_.push_back(std::move(m));
                      });
    other_->Subscribe(Channels().status,
                      [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                        service_status_t m;
                        ASSERT_TRUE(DecodeChecked(data, size, &m));
                        for (int k = 0; k < m.n_counters; ++k)
                          counters_[m.counter_name[k]] = m.counter_value[k];
                      });
  }
  static ViewQuery Query() {
    ViewQuery query;
    query.camera = ViewCamera(test::EventCamera(), 0.1);
    query.T_map_camera = SE3(ExpSO3({0.5, 0.1, 0}), {0.1, 0, 0.2}) * test::BodyCamera();
    return query;
  }
  static view_query_t Message(std::int64_t seq) {
    view_query_t m = ToMessage(Query());
    m.utime = 1'000'000 + seq;
    m.seq = seq;
    m.epoch = 5;
    return m;
  }
  void Send(const view_query_t& m) {
    std::vector<std::uint8_t> bytes;
    EncodeTo(m, &bytes);
    other_->Publish(Channels().view_query, bytes.data(), bytes.size());
  }
  void Exchange() {
    bus_->Poll(0);
    server_.Tick();
    other_->Poll(0);
  }
  std::int64_t Counter(const std::string& name) {
    server_.Stop();  // sends STATUS, the first time
    other_->Poll(0);
    return counters_.at(name);
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_), other_ = OpenMemoryBus(hub_);
  PhotometricMap map_ = test::Room().Map(0.03);
  MapServer server_;
  std::vector<map_view_t> answers_;
  std::map<std::string, std::int64_t> counters_;
};

TEST_F(ViewServerTest, AnswersAsTheLibraryDoesEveryTime) {
  Send(Message(3));
  Send(Message(3));  // the asker is impatient: drawn once
  Exchange();
  ASSERT_EQ(answers_.size(), 1u);
  Send(Message(3));  // the answer was lost: the same again
  Exchange();
  ASSERT_EQ(answers_.size(), 2u);
  PhotometricView expected;
  ViewRenderer renderer(map_);
  renderer.Render(FromMessage(Message(3)), &expected);
  const map_view_t m = ToMessage(expected);
  for (const map_view_t& answer : answers_) {
    EXPECT_EQ(answer.log_intensity, m.log_intensity);
    EXPECT_EQ(answer.inverse_depth, m.inverse_depth);
    EXPECT_EQ(answer.width, 160);
    EXPECT_EQ(answer.utime, 1'000'003);
    EXPECT_EQ(answer.query_seq, 3);
    EXPECT_EQ(answer.query_epoch, 5);
  }
  EXPECT_GT(std::count_if(m.inverse_depth.begin(), m.inverse_depth.end(), [](int v) { return v != 0; }),
            15'000);
  EXPECT_EQ(answers_[1].seq, answers_[0].seq);
  EXPECT_EQ(Counter("VIEW_QUERY.received"), 1);
  EXPECT_EQ(Counter("VIEW_QUERY.duplicate"), 2);
  EXPECT_EQ(Counter("photometric_map.points"), static_cast<std::int64_t>(map_.points.size()));
}

TEST_F(ViewServerTest, AbsurdQueriesAreCountedNotAnswered) {
  std::vector<view_query_t> bad(6, Message(1));
  bad[0].position[1] = std::nan("");
  bad[1].camera.width = 8000, bad[1].camera.height = 8000;  // an image of 64 million pixels
  bad[2].camera.distortion[0] = 0.1;
  bad[3].camera.fx = 0;
  bad[4].min_depth = 0;
  bad[5].seq = -1;
  for (const view_query_t& m : bad) Send(m);
  const std::uint8_t rubbish[] = {1, 2, 3};
  other_->Publish(Channels().view_query, rubbish, sizeof rubbish);
  Exchange();
  EXPECT_TRUE(answers_.empty());
  EXPECT_EQ(Counter("VIEW_QUERY.invalid"), 7);
}

TEST_F(ViewServerTest, AFloodKeepsTheNewest) {
  for (int k = 0; k < 50; ++k) Send(Message(k));
  Exchange();
  ASSERT_EQ(answers_.size(), 4u);
  EXPECT_EQ(answers_.back().query_seq, 49);
  EXPECT_EQ(Counter("VIEW_QUERY.dropped"), 46);
}

TEST(MapServerWithoutPoints, AnswersThatNothingIsVisible) {
  const auto hub = MakeMemoryHub();
  const auto bus = OpenMemoryBus(hub), other = OpenMemoryBus(hub);
  MapServer server(bus.get(), Channels(), MapIndex({}), "nothing");
  int visible = -1;
  other->Subscribe(Channels().map_points,
                   [&](const std::string&, const std::uint8_t* data, std::size_t size) {
                     map_points_t m;
                     ASSERT_TRUE(DecodeChecked(data, size, &m));
                     visible = m.n_visible;
                   });
  map_query_t query{};
  query.orientation[3] = 1;
  query.camera.model = "plumb_bob";
  query.camera.width = 640, query.camera.height = 480, query.camera.fx = query.camera.fy = 300;
  query.max_depth = 10, query.max_points = 100;
  std::vector<std::uint8_t> bytes;
  EncodeTo(query, &bytes);
  other->Publish(Channels().map_query, bytes.data(), bytes.size());
  bus->Poll(0);
  server.Tick();
  other->Poll(0);
  EXPECT_EQ(visible, 0);
}

}  // namespace
}  // namespace evit
