// A camera in motion before known points, whose pixels fire where the points are; calibrated from rig files
// that are wrong.
#include "common/calibration/overlap_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/geometry/degrees.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

using ::testing::HasSubstr;

constexpr Utime kBegin = 5'000'000, kEnd = 9'000'000;

class OverlapCalibrationTest : public ::testing::Test {
 protected:
  OverlapCalibrationTest() : points_(synthetic::RoomPoints(25)) {
    truth_.camera = synthetic::VgaCamera();
    truth_.T_body_camera = synthetic::BodyCamera();
    truth_.camera_time_offset = 4'000;
    for (Utime t = kBegin; t <= kEnd; t += 8'000) body_.push_back({t, BodyAt(t)});
  }

  SE3 BodyAt(Utime t) const { return {motion_.Rotation(ToSeconds(t)), motion_.Position(ToSeconds(t))}; }

  // Every `every`-th point, all the time, in the pixel where it is.
  void Fire(std::vector<MapView>* views, std::size_t every = 1) const {
    ViewFiller filler(views);
    for (Utime t = kBegin; t <= kEnd; t += 4'000) {
      const SE3 T = (BodyAt(t) * truth_.T_body_camera).Inverse();
      EventArray events;
      for (std::size_t k = 0; k < points_.size(); k += every) {
        Eigen::Vector2d pixel;
        if (truth_.camera.Project(T * points_[k].cast<double>(), &pixel) && truth_.camera.Contains(pixel))
          events.push_back(t - truth_.camera_time_offset, static_cast<std::uint16_t>(std::lround(pixel.x())),
                           static_cast<std::uint16_t>(std::lround(pixel.y())), 1);
      }
      filler.AddEvents(events);
    }
  }

  std::vector<MapView> Views(const Rig& rig) const {
    MapViewOptions options;
    options.margin_px = 60;
    return PlanViews(MapIndex(PointMap{points_}), rig, body_, options);
  }

  Rig Wrong(const Eigen::Vector3d& degrees, Utime late) const {
    Rig rig = truth_;
    rig.T_body_camera.q = rig.T_body_camera.q * ExpSO3(kRadiansPerDegree * degrees);
    rig.camera_time_offset += late;
    return rig;
  }

  double OffDegrees(const OverlapCalibration& c) const {
    return AngularDistance(truth_.T_body_camera.q, c.T_body_camera.q) / kRadiansPerDegree;
  }

  static OverlapCalibrationOptions ExactMap() {
    OverlapCalibrationOptions options;
    options.registration_px = 0.1;
    options.lag_px = 0;
    options.lag_sigma = 0.02;
    return options;
  }

  std::vector<Eigen::Vector3f> points_;
  synthetic::Motion motion_;
  bool motion_is_even_ = false;
  Rig truth_;
  Trajectory body_;
};

TEST_F(OverlapCalibrationTest, FindsTurnAndTimeOffsetFromAWrongRigFile) {
  for (const auto& [degrees, late] :
       {std::pair<Eigen::Vector3d, Utime>({0.3, -1.5, 0.4}, 0), {{-2, 1.5, -1}, -12'000}}) {
    const Rig wrong = Wrong(degrees, late);
    std::vector<MapView> views = Views(wrong);
    Fire(&views);
    const OverlapCalibration c = CalibrateByOverlap(views, body_, wrong, ExactMap());
    ASSERT_TRUE(c.success) << c.reason;
    EXPECT_TRUE(c.unobservable.empty());
    EXPECT_LT(OffDegrees(c), 0.05);
    EXPECT_NEAR(static_cast<double>(c.offset), 4'000, 1'000);
    EXPECT_LT((c.T_body_camera.p - truth_.T_body_camera.p).norm(), 0.003);
    EXPECT_GT(c.after.kappa(), c.before.kappa() + 0.1);
  }
}

TEST_F(OverlapCalibrationTest, SigmasHoldWhereMostEdgesCauseNoEvents) {
  const Rig wrong = Wrong({0.3, -1, 0.2}, 3'000);
  std::vector<MapView> views = Views(wrong);
  Fire(&views, 4);
  const OverlapCalibration c = CalibrateByOverlap(views, body_, wrong, ExactMap());
  ASSERT_TRUE(c.success) << c.reason;
  const Eigen::Vector3d turn = LogSO3(c.T_body_camera.q.conjugate() * truth_.T_body_camera.q);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(turn[k]), 3 * std::sqrt(c.covariance(3 + k, 3 + k)));
    EXPECT_LT(std::sqrt(c.covariance(3 + k, 3 + k)), 0.2 * kRadiansPerDegree);
  }
  EXPECT_LT(std::abs(ToSeconds(c.offset - 4'000)), 3 * std::sqrt(c.covariance(6, 6)));
}

TEST_F(OverlapCalibrationTest, OffsetIsKeptWhereTheMotionDoesNotShowIt) {
  const Rig wrong = Wrong({0.3, -0.5, 0.2}, 0);
  // The body turns at one rate, one way: late events and a turned camera look alike.
  motion_is_even_ = true;
  for (StampedPose& s : body_) s.pose = BodyAt(s.t);
  std::vector<MapView> views = Views(wrong);
  Fire(&views);
  const OverlapCalibration c = CalibrateByOverlap(views, body_, wrong);
  ASSERT_TRUE(c.success) << c.reason;
  const bool named = std::any_of(c.unobservable.begin(), c.unobservable.end(), [](const Unobservable& u) {
    return u.value == Unobservable::Value::kTimeOffset;
  });
  EXPECT_TRUE(named);
  EXPECT_EQ(c.offset, wrong.camera_time_offset);
}

TEST_F(OverlapCalibrationTest, EventsOfAnotherPlaceAreRefused) {
  std::vector<MapView> views = Views(truth_);
  OverlapCalibration none = CalibrateByOverlap(views, body_, truth_);
  EXPECT_FALSE(none.success);
  EXPECT_THAT(none.reason, HasSubstr("fewer than ten views"));
  std::mt19937 rng(5);
  for (MapView& view : views) {
    for (int k = 0; k < 3000; ++k)
      view.fired.Add(static_cast<int>(rng() % 640), static_cast<int>(rng() % 480));
    view.n_events = 3000;
  }
  const OverlapCalibration c = CalibrateByOverlap(views, body_, truth_);
  EXPECT_FALSE(c.success);
  EXPECT_THAT(c.reason, HasSubstr("does not come to lie on the events"));
}

}  // namespace
}  // namespace evit
