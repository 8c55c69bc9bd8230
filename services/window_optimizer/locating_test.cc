// The service without a start pose: whoever is restarted meanwhile, it finds the place, and says no pose
// before.
#include "common/localization/place_finder.h"
#include "common/localization/place_index.h"
#include "common/wire/place_wire.h"
#include "tests/helpers/window_optimizer_fixture.h"

namespace evit::test {
namespace {

class LocatingTest : public WindowOptimizerTest {
 protected:
  LocatingTest() : index_(PointMap{room_}), places_(index_.map(), Sparse()) {
    settings_.locate.emplace();
    // Those with which 160 keyframes are enough: the scene has few points, and the defaults follow real ones.
    settings_.tracker.points.per_keyframe = 4000;
    settings_.tracker.window.image_sigma = 80;
    bus_->Subscribe(channels_.place_query,
                    [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                      ASSERT_TRUE(DecodeChecked(data, size, &question_));
                      if (places_up_) AnswerPlaces();
                    });
  }
  static PlaceIndexOptions Sparse() {
    PlaceIndexOptions options;
    options.grid.spacing = 0.4;
    options.grid.max_places = 1500;
    return options;
  }
  void AnswerPlaces() {
    const PlaceFinder finder(index_, places_, RigOf(question_), settings_.tracker.points,
                             settings_.tracker.window);
    places_t answer = ToMessage(finder.Answer(FromMessage(question_)));
    answer.query_seq = question_.seq;
    answer.query_epoch = question_.epoch;
    answer.epoch = places_epoch_;
    answer.seq = places_seq_++;
    Send(channels_.places, answer);
  }
  // So many keyframes, 25 ms apart, or fewer where it tracks before.
  void Play(int count) {
    for (int k = 0; k < count && !tracking(); ++k) {
      keyframe_t keyframe = Keyframe(last_ == 0 ? 1'000'000 : last_ + 25'000);
      keyframe.epoch = keyframe_epoch_;
      Send(channels_.keyframe, keyframe);
      Pump();
    }
  }
  void PlayUntilItSearches() {
    for (int k = 0; k < 60 && places_seq_ < 2; ++k) Play(1);
    ASSERT_GE(places_seq_, 2);
    ASSERT_FALSE(tracking());
  }
  bool tracking() const { return !modes_.empty() && modes_.back().mode == tracker_mode_t::TRACKING; }
  void ExpectTheRightPlace() {
    Play(160);
    ASSERT_TRUE(tracking()) << modes_.back().reason;
    ASSERT_FALSE(windows_.empty());
    for (const window_state_t& window : windows_) {
      const node_state_t& newest = window.node.back();
      const SE3 truth = motion_.State(ToSeconds(newest.utime)).T_map_body;
      EXPECT_LT((Eigen::Vector3d(newest.position) - truth.p).norm(), 0.03);
    }
  }

  MapIndex index_;
  PlaceIndex places_;
  place_query_t question_{};
  bool places_up_ = true;
  std::int64_t places_epoch_ = 9, places_seq_ = 0, keyframe_epoch_ = 77;
};

TEST_F(LocatingTest, ItIsRestartedDuringTheSearch) {
  Start(true);
  PlayUntilItSearches();
  service_.reset();
  keyframe_seq_ = 0;  // lossless streams begin again
  keyframe_epoch_ = 78;
  StartAgain();
  ExpectTheRightPlace();
}

TEST_F(LocatingTest, MapServerIsRestartedDuringTheSearch) {
  Start(false);
  PlayUntilItSearches();
  places_up_ = false;
  Play(12);
  places_up_ = true;
  places_epoch_ = 10;
  places_seq_ = 0;
  ExpectTheRightPlace();
}

TEST_F(LocatingTest, FrameBuilderIsRestartedDuringTheSearch) {
  Start(false);
  PlayUntilItSearches();
  keyframe_epoch_ = 78;
  keyframe_seq_ = 0;
  last_ += 700'000;
  Keyframe(last_);  // the first of the new stream has no IMU samples before it, and is lost
  ExpectTheRightPlace();
}

TEST_F(LocatingTest, WhatIsKnownOfThePlaceIsAskedWith) {
  Start(true);
  place_prior_t prior =
      ToMessage(PlacePrior{{}, PlacePrior::Between{-1, 1}, PlacePrior::Heading{EIGEN_PI, 0.5}});
  prior.epoch = 4;
  Send(channels_.place_prior, prior);
  place_query_t search{};  // the newest; between them candidates are refined
  for (int k = 0; k < 60; ++k) {
    Play(1);
    if (question_.everywhere != 0) search = question_;
  }
  EXPECT_FALSE(tracking());  // it looks the other way
  EXPECT_EQ(search.yaw, prior.yaw);
  EXPECT_EQ(search.height_low, -1);
  EXPECT_LT(search.near_radius, 0);
  prior.seq = 1;
  prior.yaw = 0;
  Send(channels_.place_prior, prior);
  prior.seq = 2;
  prior.yaw = std::nan("");
  Send(channels_.place_prior, prior);
  ExpectTheRightPlace();
  EXPECT_EQ(Counter("PLACE_PRIOR.invalid"), 1);
}

}  // namespace
}  // namespace evit::test
