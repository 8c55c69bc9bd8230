#include "tools/formats/vector/sequence_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/evaluation/trajectory.h"
#include "common/files/decimal_time.h"
#include "common/wire/event_wire.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/hdf5/event_file_writer.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr Utime kStart = 1'642'661'138'836'530;
constexpr Utime kSilenceBegin = kStart + 400'000, kSilenceEnd = kStart + 500'000;

// One second of a made-up sequence: 300,000 events with a burst and a tenth of a second of silence, 200 Hz
// IMU and 100 Hz truth.
class SequenceImportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("import_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_ / "in");
    std::mt19937 rng(3);
    for (Utime t = kStart; t < kStart + 1'000'000; ++t) {
      if (t >= kSilenceBegin && t < kSilenceEnd) continue;
      const bool burst = t >= kStart + 700'000 && t < kStart + 702'000;
      const unsigned n = burst ? 50 : t == kStart ? 1 : rng() % 3 / 2;
      for (unsigned k = 0; k < n; ++k) events_.push_back(t, rng() % 640, rng() % 480, rng() % 2);
    }
    EventFileWriter writer(In("left_event.hdf5"), kStart - 77);
    writer.Append(events_);
    writer.Close();
    std::ofstream imu(In("imu.txt"));
    imu << "# one\n# two\n# timestamp gx gy gz ax ay az qx qy qz qw\n";
    for (int k = 0; k < 200; ++k) {
      imu << DecimalSeconds(kStart + Utime{5000} * k) << ' ' << k << " 2 3 4 5 9.81 0 0 0 1\n";
    }
    std::ofstream truth(In("gt.txt"));
    truth << "# one\n# two\n";
    for (int k = 0; k < 100; ++k) {
      const StampedPose pose{kStart + Utime{10'000} * k, {Eigen::Quaterniond::Identity(), {0.01 * k, 1, 2}}};
      truth << TumLine(pose) << '\n';
    }
    job_.folder = (folder_ / "in").string();
    job_.name = "made_up";
    job_.out = (folder_ / "out.lcmlog").string();
    job_.any_imu = true;  // made-up numbers
    job_.rig.camera.width = 640;
    job_.rig.camera.height = 480;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string In(const std::string& what) const {
    return (folder_ / "in" / ("made_up1.synced." + what)).string();
  }
  ImportSummary Import() const {
    return ImportSequence(job_, [](double) {});
  }
  /// Names of all files beside the input.
  std::vector<std::string> Outputs() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (entry.path().filename() != "in") names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  std::filesystem::path folder_;
  EventArray events_;
  SequenceImport job_;
};

template <typename Message>
Message Decode(const LogReader& log, const LogEntry& entry) {
  std::vector<std::uint8_t> bytes;
  log.Read(entry, &bytes);
  Message message;
  std::string why;
  EXPECT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &message, &why)) << why;
  return message;
}

TEST_F(SequenceImportTest, EventsRoundTripInSmallPackets) {
  const ImportSummary summary = Import();
  EXPECT_EQ(summary.n_events, static_cast<std::int64_t>(events_.size()));
  const LogReader log(job_.out);
  EventArray out;
  Utime last_log_time = 0, known = kStart;
  std::int64_t seq = 0;
  for (const LogEntry& entry : log.entries()) {
    EXPECT_GE(entry.utime, last_log_time);
    last_log_time = entry.utime;
    if (log.channel(entry) != "EVENTS") continue;
    const auto m = Decode<event_packet_t>(log, entry);
    EXPECT_EQ(m.seq, seq++);
    ASSERT_LE(m.n, 7000);
    EXPECT_LE(entry.size, 63 << 10);
    const Utime end = m.n > 0 ? m.utime + m.dt_us.back() : m.utime;
    EXPECT_LE(end - m.utime, 5000);
    EXPECT_EQ(entry.utime, end);  // played when it is complete
    EXPECT_LE(end - known, 10'001);
    known = end;
    AppendEvents(m, &out);
  }
  EXPECT_EQ(seq, summary.n_packets);
  EXPECT_EQ(out.t, events_.t);
  EXPECT_EQ(out.x, events_.x);
  EXPECT_EQ(out.y, events_.y);
  EXPECT_EQ(out.p, events_.p);
}

TEST_F(SequenceImportTest, ImuSamplesKeepFullPrecision) {
  EXPECT_EQ(Import().n_imu, 200);
  const LogReader log(job_.out);
  int n = 0;
  for (const LogEntry& entry : log.entries()) {
    if (log.channel(entry) != "IMU") continue;
    const auto m = Decode<imu_batch_t>(log, entry);
    ASSERT_EQ(m.n, 1);
    EXPECT_EQ(m.seq, n);
    EXPECT_EQ(m.sample_utime[0], kStart + Utime{5000} * n);
    EXPECT_EQ(entry.utime, m.utime);
    EXPECT_EQ(m.gyro[0], (std::vector<double>{1.0 * n, 2, 3}));
    EXPECT_EQ(m.accel[0], (std::vector<double>{4, 5, 9.81}));
    ++n;
  }
  EXPECT_EQ(n, 200);
}

TEST_F(SequenceImportTest, TruthBecomesTheBodyInTheMap) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  job_.T_map_world = {turn, {10, 20, 30}};
  job_.rig.T_marker_body = {Eigen::Quaterniond::Identity(), {0, 0, 0.5}};
  EXPECT_EQ(Import().n_truth, 100);
  const Trajectory truth = ReadTum(job_.out + ".truth.tum");
  ASSERT_EQ(truth.size(), 100U);
  // World (0.01 k, 1, 2.5) turned by 90 degrees about z, then moved.
  EXPECT_TRUE(truth[40].pose.p.isApprox(Eigen::Vector3d(10 - 1, 20 + 0.4, 32.5), 1e-9));
  EXPECT_NEAR(AngularDistance(truth[40].pose.q, turn), 0, 1e-8);
  const LogReader log(job_.out);
  std::size_t n = 0;
  for (const LogEntry& entry : log.entries()) {
    if (log.channel(entry) != "GROUND_TRUTH") continue;
    const auto m = Decode<body_pose_t>(log, entry);
    EXPECT_EQ(m.utime, truth[n].t);
    EXPECT_NEAR(m.position[1], truth[n].pose.p.y(), 1e-8);
    ++n;
  }
  EXPECT_EQ(n, truth.size());
}

TEST_F(SequenceImportTest, PartOfASequence) {
  job_.seconds = {0.2, 0.6};
  const ImportSummary summary = Import();
  EXPECT_EQ(summary.n_imu, 81);
  EXPECT_NEAR(summary.seconds, 0.4, 0.001);
  const LogReader log(job_.out);
  EXPECT_GE(log.entries().front().utime, kStart + 200'000);
  EXPECT_LE(log.entries().back().utime, kStart + 600'000);
}

TEST_F(SequenceImportTest, TruthMayBeAbsent) {
  Import();  // leaves a truth file that must not stay
  std::filesystem::remove(In("gt.txt"));
  EXPECT_EQ(Import().n_truth, 0);
  EXPECT_THAT(Outputs(), ::testing::ElementsAre("out.lcmlog"));
}

TEST_F(SequenceImportTest, SameFilesGiveTheSameLog) {
  const auto bytes = [&] {
    Import();
    std::ifstream file(job_.out, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  };
  const std::string first = bytes();
  EXPECT_TRUE(first == bytes());
}

TEST_F(SequenceImportTest, WrongNameListsTheSequences) {
  job_.name = "desk";
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("desk"), HasSubstr("found there: made_up"))));
}

TEST_F(SequenceImportTest, TheOnlySequenceNeedsNoName) {
  const TemporaryFolder folder("only_sequence");
  EXPECT_THAT([&] { OnlySequence(folder.File("")); },
              ThrowsMessage<std::runtime_error>(HasSubstr("holds no sequence")));
  folder.Write("desk_normal1.synced.left_event.hdf5", "");
  EXPECT_EQ(OnlySequence(folder.File("")), "desk_normal");
  folder.Write("sofa_fast1.synced.left_event.hdf5", "");
  EXPECT_THAT([&] { OnlySequence(folder.File("")); },
              ThrowsMessage<std::runtime_error>(HasSubstr("--sequence: desk_normal, sofa_fast")));
}

TEST_F(SequenceImportTest, AnEventFarFromItsPlaceIsCountedAndDropped) {
  const hid_t file = H5Fopen(In("left_event.hdf5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t times = H5Dopen2(file, "events/t", H5P_DEFAULT), space = H5Dget_space(times);
  const hsize_t at = 250'000, one = 1;
  const hid_t single = H5Screate_simple(1, &one, nullptr);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, nullptr, &one, nullptr);
  const std::uint32_t early = 5;
  EXPECT_GE(H5Dwrite(times, H5T_NATIVE_UINT32, single, space, H5P_DEFAULT, &early), 0);
  H5Sclose(single), H5Sclose(space), H5Dclose(times), H5Fclose(file);
  const ImportSummary summary = ImportSequence(job_, [](double) {});
  EXPECT_EQ(summary.dropped_events.late, 1);
  EXPECT_EQ(summary.n_events, static_cast<std::int64_t>(events_.size()) - 1);
}

TEST_F(SequenceImportTest, EventsOutsideTheCameraAreRefused) {
  job_.rig.camera.width = 346;
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("outside")));
  EXPECT_THAT(Outputs(), ::testing::IsEmpty());
}

TEST_F(SequenceImportTest, UnusableInputsAndOutputsAreNamed) {
  SequenceImport job = job_;
  job.out = (folder_ / "no" / "such.lcmlog").string();
  EXPECT_THAT([&] { ImportSequence(job, [](double) {}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("such.lcmlog")));
  job = job_;
  job.seconds = {50, 60};
  EXPECT_THAT([&] { ImportSequence(job, [](double) {}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("--seconds")));
  std::filesystem::resize_file(In("left_event.hdf5"), 1000);
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("left_event.hdf5")));
  std::filesystem::remove(In("imu.txt"));
  EXPECT_THAT(Outputs(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace evit::formats
