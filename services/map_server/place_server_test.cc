#include "services/map_server/place_server.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <thread>

#include "common/bus/codec.h"
#include "common/bus/memory_bus.h"
#include "common/wire/place_wire.h"
#include "services/map_server/map_server.h"
#include "tests/helpers/synthetic_room.h"

namespace evit {
namespace {

const SE3 kHere(ExpSO3({0, 0, 2.1}), {0.4, -0.6, 0.2});

class PlaceServerTest : public ::testing::Test {
 protected:
  PlaceServerTest() : server_(bus_.get(), Channels(), MapIndex(Corner()), "a corner") {
    other_->Subscribe(Channels().places,
                      [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                        places_t m;
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
  // A small part of a room, whose index is made in no time.
  static PointMap Corner() {
    PointMap map = synthetic::WalledRoom(1), corner;
    for (const Eigen::Vector3f& p : map.points)
      if (p.x() < 0 && p.y() > 0 && p.z() > 0) corner.points.push_back(p);
    return corner;
  }
  static place_query_t Query(std::int64_t seq) {
    PlaceQuery query;
    query.number = 1 + seq;
    query.surface = synthetic::SeenFrom(Corner(), kHere);
    query.hypotheses = {kHere.Plus((Vector6d() << 0.02, 0, 0.02, 0, 0.01, 0).finished())};
    query.everywhere = false;
    place_query_t m = ToMessage(query, synthetic::IndexedRoom::TestRig());
    m.seq = seq;
    m.epoch = 5;
    return m;
  }
  void Send(const place_query_t& m) {
    std::vector<std::uint8_t> bytes;
    EncodeTo(m, &bytes);
    other_->Publish(Channels().place_query, bytes.data(), bytes.size());
  }
  void Exchange() {
    bus_->Poll(0);
    server_.Tick();
    other_->Poll(0);
  }
  // Until there are so many answers; the thread takes what time it needs.
  void WaitFor(std::size_t answers) {
    for (int k = 0; k < 60'000 && answers_.size() < answers; ++k) {
      Exchange();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_EQ(answers_.size(), answers);
  }
  std::int64_t Counter(const std::string& name) {
    server_.Stop();
    other_->Poll(0);
    return counters_.at(name);
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_), other_ = OpenMemoryBus(hub_);
  std::vector<places_t> answers_;
  std::map<std::string, std::int64_t> counters_;
  MapServer server_;
};

TEST_F(PlaceServerTest, AnswersOnceAndAgainWhereTheAnswerWasLost) {
  Send(Query(3));
  Send(Query(3));  // the asker is impatient
  WaitFor(1);
  EXPECT_EQ(answers_[0].query_seq, 3);
  EXPECT_EQ(answers_[0].query_epoch, 5);
  ASSERT_GE(answers_[0].n, 1);
  EXPECT_LT((Eigen::Vector3d(answers_[0].position[0].data()) - kHere.p).norm(), 0.03);
  Exchange();
  Send(Query(3));  // lost: the same bytes again
  WaitFor(2);
  EXPECT_EQ(answers_[1].seq, answers_[0].seq);
  Send(Query(4));
  WaitFor(3);
  EXPECT_EQ(answers_[2].query_seq, 4);
  EXPECT_GT(Counter("places.indexed"), 0);
}

TEST_F(PlaceServerTest, TheIndexIsKeptFromOneRunToTheNext) {
  const std::string path = ::testing::TempDir() + std::to_string(getpid()) + "corner.pcd.places";
  std::filesystem::remove(path);
  server_.KeepPlacesIn({path});
  Send(Query(1));
  WaitFor(1);
  EXPECT_EQ(Counter("places.read"), 0);
  const std::unique_ptr<Bus> bus = OpenMemoryBus(hub_);
  MapServer again(bus.get(), Channels(), MapIndex(Corner()), "a corner");
  again.KeepPlacesIn({path});
  again.PreparePlaces();
  counters_.clear();
  for (int k = 0; k < 60'000 && counters_.count("places.read") == 0; ++k) {
    again.Tick();
    other_->Poll(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(counters_["places.read"], 1);
  std::filesystem::remove(path);
}

TEST_F(PlaceServerTest, AbsurdQuestionsAreCountedNotAnswered) {
  std::vector<place_query_t> bad(4, Query(1));
  bad[0].up[0] = std::nan("");
  bad[1].hypothesis_orientation[0] = {0, 0, 0, 2};
  bad[2].camera.fx = 0;
  bad[3].attempt = -1;
  for (const place_query_t& m : bad) Send(m);
  Exchange();
  EXPECT_EQ(Counter("PLACE_QUERY.invalid"), 4);
  EXPECT_TRUE(answers_.empty());
}

}  // namespace
}  // namespace evit
