#include "tools/formats/bag/bag_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "tests/helpers/imported_log.h"
#include "tests/helpers/ros_bags.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr Utime kStart = 1'642'661'138'836'530;
constexpr char kDvs[] = "dvs_msgs/EventArray", kProphesee[] = "prophesee_event_msgs/EventArray";

// Half a second of events, IMU and truth.
class BagImportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::mt19937 rng(3);
    for (Utime t = kStart; t < kStart + 500'000; t += rng() % 9)
      made_.events.push_back(t, rng() % 240, rng() % 180, rng() % 2);
    for (int k = 0; k < 100; ++k) {
      const double h = k % 2 == 0 ? 0.5 : -0.5;  // exactly of length 1
      made_.imu.push_back({kStart + Utime{5000} * k, {k / 7.0, 0.1, -2e-5}, {9.81, 1.0 / 3, -0.0625 * k}});
      made_.truth.push_back(
          {kStart + Utime{5000} * k, {Eigen::Quaterniond(0.5, h, 0.5, 0.5), {0.1 * k, 1.0 / 3, -0.3}}});
    }
    job_.out = Path("out.lcmlog");
    job_.any_imu = true;  // made-up numbers
    job_.rig.camera.width = 240;
    job_.rig.camera.height = 180;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  /// Events of [begin, end) in messages of a thousand.
  void RecordEvents(rosbag::Bag* bag, const char* type, std::size_t begin, std::size_t end) const {
    for (std::size_t next = 0; begin < end; begin = next) {
      next = std::min(begin + 1000, end);
      Record(bag, "/events", made_.events.t[next - 1], EventsMessage(type, made_.events, begin, next));
    }
  }
  void RecordImu(rosbag::Bag* bag) const {
    for (const ImuSample& s : made_.imu) Record(bag, "/imu", s.t, ImuMessage(s));
  }
  void RecordTruth(rosbag::Bag* bag) const {
    for (const StampedPose& s : made_.truth) Record(bag, "/pose", s.t, PoseMessage(s));
  }
  /// One bag with everything.
  void MakeBag(rosbag::CompressionType compression = rosbag::compression::Uncompressed) {
    rosbag::Bag bag(Path("all.bag"), rosbag::bagmode::Write);
    bag.setCompression(compression);
    RecordEvents(&bag, kDvs, 0, made_.events.size());
    RecordImu(&bag);
    RecordTruth(&bag);
    job_.files = {Path("all.bag")};
  }
  ImportSummary Import() const {
    return ImportBag(job_, [](double) {});
  }
  void ExpectAll() const {
    const ImportSummary summary = Import();
    EXPECT_EQ(summary.n_events, static_cast<std::int64_t>(made_.events.size()));
    EXPECT_EQ(summary.dropped_events.total() + summary.dropped_imu.total() + summary.dropped_truth.total(),
              0);
    const ImportedLog out = ReadImported(job_.out);
    ExpectSame(out.events, made_.events);
    ExpectSame(out.imu, made_.imu);
    ExpectSame(out.truth, made_.truth);
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ("bag_" + std::to_string(getpid()));
  ImportedLog made_;
  BagImport job_;
};

TEST_F(BagImportTest, StreamsRoundTripUnderEveryCompression) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    MakeBag(compression);
    ExpectAll();
  }
}

TEST_F(BagImportTest, SeveralBagsAreMergedByTime) {
  const std::size_t half = made_.events.size() / 2;
  job_.files = {Path("late.bag"), Path("imu.bag"), Path("early.bag"), Path("truth.bag")};
  rosbag::Bag late(job_.files[0], rosbag::bagmode::Write), imu(job_.files[1], rosbag::bagmode::Write),
      early(job_.files[2], rosbag::bagmode::Write), truth(job_.files[3], rosbag::bagmode::Write);
  RecordEvents(&early, kProphesee, 0, half);
  RecordEvents(&late, kProphesee, half, made_.events.size());
  RecordImu(&imu);
  RecordTruth(&truth);
  for (rosbag::Bag* bag : {&late, &imu, &early, &truth}) bag->close();
  ExpectAll();
}

TEST_F(BagImportTest, TheSameEventsTwiceAreRefused) {
  job_.files = {Path("a.bag"), Path("b.bag")};
  for (const std::string& file : job_.files) {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    RecordEvents(&bag, kProphesee, 0, made_.events.size());
    RecordImu(&bag);
  }
  EXPECT_THAT([&] { ImportBag(job_, [](double) {}); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("a.bag"), HasSubstr("b.bag"))));
  EXPECT_FALSE(std::filesystem::exists(job_.out));
}

TEST_F(BagImportTest, TruthBecomesTheBodyInTheMap) {
  MakeBag();
  job_.rig.T_marker_body = {Eigen::Quaterniond::Identity(), {0, 0, 0.5}};
  job_.T_map_world = {Eigen::Quaterniond::Identity(), {10, 20, 30}};
  Import();
  const ImportedLog out = ReadImported(job_.out);
  ASSERT_EQ(out.truth.size(), 100U);
  const Eigen::Vector3d up(0, 0, 0.5), moved(10, 20, 30);
  EXPECT_TRUE(out.truth[9].pose.p.isApprox(made_.truth[9].pose * up + moved, 1e-12));
}

TEST_F(BagImportTest, TruthMayBeOdometryOrATransform) {
  for (const char* type :
       {"geometry_msgs/TransformStamped", "geometry_msgs/PoseWithCovarianceStamped", "nav_msgs/Odometry"}) {
    job_.files = {Path("truth.bag")};
    {
      rosbag::Bag bag(job_.files[0], rosbag::bagmode::Write);
      RecordEvents(&bag, kDvs, 0, made_.events.size());
      RecordImu(&bag);
      for (const StampedPose& s : made_.truth) Record(&bag, "/truth", s.t, TruthMessage(type, s));
    }
    Import();
    ExpectSame(ReadImported(job_.out).truth, made_.truth);
  }
}

TEST_F(BagImportTest, APoseIsPreferredToAnOdometry) {
  MakeBag();
  rosbag::Bag bag(Path("all.bag"), rosbag::bagmode::Append);
  for (const StampedPose& s : made_.truth)
    Record(&bag, "/vio", s.t, TruthMessage("nav_msgs/Odometry", {s.t, {}}));
  bag.close();
  Import();
  ExpectSame(ReadImported(job_.out).truth, made_.truth);
}

TEST_F(BagImportTest, InvalidEntriesAreCountedAndDropped) {
  MakeBag();
  rosbag::Bag bag(Path("all.bag"), rosbag::bagmode::Append);
  const Utime t = kStart + 600'000;
  EventArray odd;
  odd.push_back(kStart, 1, 1, 1);
  odd.push_back(t, 240, 0, 1);
  odd.push_back(t, 0, 180, 1);
  odd.push_back(t, 239, 179, 1);
  Record(&bag, "/events", t, EventsMessage(kDvs, odd, 0, 4));
  Record(&bag, "/imu", t, ImuMessage(made_.imu.front()));
  Record(&bag, "/imu", t, ImuMessage({t, {0, NAN, 0}, {0, 0, 9.81}}));
  Record(&bag, "/pose", t, PoseMessage({t, {Eigen::Quaterniond(0, 0, 0, 0), {1, 2, 3}}}));
  Record(&bag, "/pose", t, PoseMessage({kStart, {}}));
  bag.close();
  const ImportSummary summary = Import();
  EXPECT_EQ(summary.dropped_events.late, 1);
  EXPECT_EQ(summary.dropped_events.outside, 2);
  EXPECT_EQ(summary.dropped_imu.late, 1);
  EXPECT_EQ(summary.dropped_imu.invalid, 1);
  EXPECT_EQ(summary.dropped_truth.late, 1);
  EXPECT_EQ(summary.dropped_truth.invalid, 1);
  const ImportedLog out = ReadImported(job_.out);
  made_.events.push_back(t, 239, 179, 1);
  ExpectSame(out.events, made_.events);
  ExpectSame(out.imu, made_.imu);
  ExpectSame(out.truth, made_.truth);
}

TEST_F(BagImportTest, MissingStreamsListTheTopics) {
  job_.files = {Path("part.bag")};
  {
    rosbag::Bag bag(job_.files[0], rosbag::bagmode::Write);
    RecordEvents(&bag, kDvs, 0, 5000);
  }
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("part.bag"), HasSubstr("holds no IMU"),
                                                      HasSubstr("/events (dvs_msgs/EventArray)"))));
  {
    rosbag::Bag bag(job_.files[0], rosbag::bagmode::Write);
    RecordImu(&bag);
  }
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("holds no events"), HasSubstr("/imu"))));
}

TEST_F(BagImportTest, ADamagedMessageIsNamed) {
  MakeBag();
  {
    rosbag::Bag bag(Path("all.bag"), rosbag::bagmode::Append);
    RawMessage cut = ImuMessage(made_.imu.back());
    cut.bytes.resize(100);
    Record(&bag, "/imu", made_.imu.back().t + 5000, cut);
  }
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("all.bag: /imu, message 101: "), HasSubstr("the bag is damaged"))));
  EXPECT_FALSE(std::filesystem::exists(job_.out + ".part"));
}

}  // namespace
}  // namespace evit::formats
