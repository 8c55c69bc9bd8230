#include "services/window_optimizer/map_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/memory_bus.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

using ::testing::ElementsAre;

// Writes down what it is told.
class NotingTracker : public MapTracker {
 public:
  void Start(const SE3& /*T_map_body*/) override {}
  void Start(const BodyState& /*state*/) override {}
  void Start(Utime /*t*/, const BodyState& /*state*/, const Matrix15d& /*information*/) override {}
  VisibilityQuery NextQuery() const override {
    VisibilityQuery query;
    query.camera = synthetic::VgaCamera();
    return query;
  }
  VisibilityQuery QueryAfter(const KeyframeInput& /*keyframe*/) const override { return NextQuery(); }
  void AddVisible(const std::vector<std::int32_t>& ids,
                  const std::vector<Eigen::Vector3f>& /*points*/) override {
    told.push_back("add " + std::to_string(ids.size()));
  }
  void ForgetPoints() override { told.emplace_back("forget"); }
  TrackerOutput Process(const KeyframeInput& /*keyframe*/) override { return {}; }
  void set_point_share(double /*share*/) override {}
  void set_solve_budget(double /*seconds*/) override {}
  TrackerMode mode() const override { return TrackerMode::kTracking; }
  const BodyState& state() const override { return state_; }
  Utime state_time() const override { return 1; }
  const Eigen::Vector3d& rate() const override { return rate_; }

  std::vector<std::string> told;

 private:
  BodyState state_;
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
};

class MapClientTest : public ::testing::Test {
 protected:
  void SetUp() override {
    server_->Subscribe(channels_.map_query,
                       [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                         ASSERT_TRUE(DecodeChecked(data, size, &query_));
                       });
  }
  /// A question, and a server's answer of two points.
  void AskAndAnswer(std::int64_t epoch, std::int64_t map_id) {
    client_.Ask(tracker_, now_);
    server_->Poll(0);
    map_points_t answer{};
    answer.epoch = epoch;
    answer.map_id = map_id;
    answer.query_seq = query_.seq;
    answer.query_epoch = query_.epoch;
    answer.n = answer.n_visible = 2;
    answer.map_size = 10;
    answer.id = {3, 4};
    answer.x = {1, 4}, answer.y = {2, 5}, answer.z = {3, 6};
    std::vector<std::uint8_t> bytes;
    EncodeTo(answer, &bytes);
    ASSERT_TRUE(client_.OnAnswer(bytes.data(), bytes.size(), now_));
    client_.Serve(&tracker_);
  }

  Channels channels_;
  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_), server_ = OpenMemoryBus(hub_);
  StatusReporter status_{bus_.get(), channels_, "window_optimizer", 1};
  MapClient::Clock::time_point now_{};
  MapClient client_{bus_.get(), channels_, &status_, now_};
  NotingTracker tracker_;
  map_query_t query_{};
};

TEST_F(MapClientTest, AServerThatComesBackWithTheSameMapCostsNothing) {
  AskAndAnswer(1, 77);
  AskAndAnswer(2, 77);
  EXPECT_THAT(tracker_.told, ElementsAre("add 2", "add 2"));
}

TEST_F(MapClientTest, PointsOfAnotherMapReplaceThoseOfTheMapBefore) {
  AskAndAnswer(1, 77);
  AskAndAnswer(2, -5);
  AskAndAnswer(2, -5);
  EXPECT_THAT(tracker_.told, ElementsAre("add 2", "forget", "add 2", "add 2"));
  EXPECT_EQ(status_.Counter("MAP_POINTS.new_map"), 1);
}

TEST_F(MapClientTest, AnAnswerIsHandedOverOnce) {
  AskAndAnswer(1, 77);
  client_.Serve(&tracker_);
  EXPECT_THAT(tracker_.told, ElementsAre("add 2"));
}

}  // namespace
}  // namespace evit
