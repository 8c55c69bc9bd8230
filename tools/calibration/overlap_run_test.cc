#include "tools/calibration/overlap_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/map/map_file.h"
#include "common/wire/event_wire.h"
#include "tools/calibration/overlap_statistics.h"
#include "tools/calibration/recorded_events.h"

namespace evit::calibration {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr Utime kBegin = 1'000'000, kEnd = 2'000'000;

// A wall of points before a camera that moves sideways; each fires where it is, every 5 ms.
class OverlapFilesTest : public ::testing::Test {
 protected:
  OverlapFilesTest()
      : folder_(::testing::TempDir() + "overlap_" + std::to_string(getpid())),
        files_{folder_ + "/a.lcmlog", folder_ + "/map.pcd", folder_ + "/truth.tum", {}} {
    std::filesystem::create_directories(folder_);
    rig_.camera.width = 320;
    rig_.camera.height = 240;
    rig_.camera.fx = rig_.camera.fy = 200;
    rig_.camera.cx = 160;
    rig_.camera.cy = 120;
    PointMap map;
    for (int k = 0; k < 300; ++k)
      map.points.emplace_back(0.0113F * static_cast<float>(k % 200) - 1.0F,
                              0.01F * static_cast<float>(k * 37 % 160) - 0.8F, 2.0F);
    WritePcd(files_.map, map);
    Trajectory body;
    for (Utime t = kBegin; t <= kEnd; t += 10'000) body.push_back({t, BodyAt(t)});
    WriteTum(files_.truth, body);
    EventArray events;
    for (Utime t = kBegin; t <= kEnd; t += 5'000) {
      for (const Eigen::Vector3f& p : map.points) {
        Eigen::Vector2d pixel;
        if (rig_.camera.Project(BodyAt(t).Inverse() * p.cast<double>(), &pixel) &&
            rig_.camera.Contains(pixel))
          events.push_back(t, static_cast<std::uint16_t>(std::lround(pixel.x())),
                           static_cast<std::uint16_t>(std::lround(pixel.y())), 1);
      }
    }
    WriteLog(files_.log, events);
  }
  ~OverlapFilesTest() override { std::filesystem::remove_all(folder_); }

  static SE3 BodyAt(Utime t) {
    return {Eigen::Quaterniond::Identity(),
            {0.2 * std::sin(3 * ToSeconds(t)), 0.1 * std::sin(5 * ToSeconds(t)), 0}};
  }

  static void WriteLog(const std::string& path, const EventArray& events) {
    LogWriter log(path);
    std::vector<std::uint8_t> bytes;
    for (const event_packet_t& packet : ToPackets(events, 1, 0)) {
      EncodeTo(packet, &bytes);
      log.Write(packet.utime, "EVENTS", bytes.data(), bytes.size());
    }
    log.Write(kEnd, "OTHER", "rubbish", 7);
    log.Close();
  }

  std::string Error() const {
    try {
      ReadViews(files_, rig_, ReadTruth(files_));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  std::string folder_;
  OverlapFiles files_;
  Rig rig_;
};

TEST_F(OverlapFilesTest, ViewsHaveTheEventsOfTheLog) {
  const std::vector<MapView> views = ReadViews(files_, rig_, ReadTruth(files_));
  ASSERT_GT(views.size(), 20U);
  const MapEventOverlap overlap = MeasureOverlap(rig_, views);
  EXPECT_GT(overlap.point_share(), 0.95);
  EXPECT_GT(overlap.event_share(), 0.95);
  const OverlapStatistics statistics = MeasureFiles(files_, rig_);
  EXPECT_GT(statistics.surface.contrast(), 0.1);
  EXPECT_GT(statistics.event_rate, 10'000);
  EXPECT_THAT(StatisticsRow("wall", statistics), AllOf(HasSubstr("| wall |"), HasSubstr("100 (")));
}

TEST_F(OverlapFilesTest, OnlyThePartAskedForIsUsed) {
  files_.seconds = {0.2, 0.5};
  const Trajectory body = ReadTruth(files_);
  EXPECT_EQ(body.front().t, kBegin + 200'000);
  EXPECT_EQ(body.back().t, kBegin + 500'000);
  files_.seconds = {5, 6};
  EXPECT_THROW(ReadTruth(files_), std::runtime_error);
}

TEST_F(OverlapFilesTest, ErrorsNameTheFileAndTheRemedy) {
  EXPECT_EQ(Error(), "");
  EventArray late;
  late.push_back(kEnd + 10'000'000, 1, 1, 1);
  WriteLog(files_.log, late);
  EXPECT_THAT(Error(), AllOf(HasSubstr(files_.log), HasSubstr("one clock")));
  WriteLog(files_.log, {});
  EXPECT_THAT(Error(), AllOf(HasSubstr(files_.log), HasSubstr("holds no EVENTS")));
  PointMap behind;
  for (int k = 0; k < 50; ++k) behind.points.emplace_back(0.01F * static_cast<float>(k), 0.0F, -3.0F);
  WritePcd(files_.map, behind);
  EXPECT_THAT(Error(), AllOf(HasSubstr(files_.map), HasSubstr("in one frame")));
}

TEST(OverlapText, SaysWhatWasFoundAndWhatTheMotionDoesNotShow) {
  Rig before;
  OverlapCalibration found;
  found.T_body_camera = before.T_body_camera;
  found.T_body_camera.q = ExpSO3({0, 0.02, 0});
  found.covariance.diagonal().setConstant(1e-6);
  found.after.views = 12;
  found.after.points = 100;
  found.after.points_on_events = 64;
  EXPECT_THAT(OverlapText(before, found), AllOf(HasSubstr("12 views"), HasSubstr("turned by 1.15 deg"),
                                                HasSubstr("64.0 %"), Not(HasSubstr("NOT OBSERVABLE"))));
  found.unobservable.push_back({Unobservable::Value::kTimeOffset, Eigen::Vector3d::Zero(), 0.008});
  EXPECT_THAT(OverlapText(before, found),
              HasSubstr("NOT OBSERVABLE from this motion: time offset, known to 8.0 ms only"));
  EXPECT_THAT(OverlapRigComment(before, found, "From a.lcmlog."),
              AllOf(HasSubstr("From a.lcmlog."), HasSubstr("y [deg]: 1.146, was 0.000, sigma 0.057"),
                    HasSubstr("not observable: time offset")));
  const Rig calibrated = Calibrated(before, found);
  EXPECT_EQ(calibrated.T_body_camera.q.coeffs(), found.T_body_camera.q.coeffs());
  EXPECT_NEAR(calibrated.T_body_camera_sigma.rotation.y(), 1e-3, 1e-12);
  EXPECT_NEAR(calibrated.T_body_camera_sigma.translation.z(), 1e-3, 1e-12);
}

}  // namespace
}  // namespace evit::calibration
