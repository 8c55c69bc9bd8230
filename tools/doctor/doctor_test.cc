#include "tools/doctor/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include "common/diagnosis/clock_checks.h"
#include "common/diagnosis/event_checks.h"
#include "common/diagnosis/imu_checks.h"
#include "tests/helpers/doctor_faults.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::doctor {
namespace {

using diagnosis::Finding;
using diagnosis::Findings;
using diagnosis::Severity;
using ::testing::AllOf;
using ::testing::HasSubstr;

const Sample& GoodSample() {
  static const Sample sample =
      LoadSample(test::SourcePath("logs/sample.lcmlog"), test::SourcePath("logs/rig.textproto"),
                 test::SourcePath("logs/sample_map.pcd"), test::SourcePath("logs/sample_truth.tum"));
  return sample;
}

class DoctorFault : public testing::TestWithParam<Fault> {};

// What events or IMU show by themselves is looked at without the map, which takes half of the time. With it:
// doctor_real_test and scripts/doctor --faults.
bool ShowsWithoutMap(const Fault& fault) {
  static const std::set<std::string> checks{
      "polarity",   "sensor-size", "event-gaps",     "dead-pixels",     "hot-pixels",    "event-noise",
      "flicker",    "event-rate",  "imu-accel-unit", "imu-gyro-unit",   "imu-gyro-axes", "imu-saturation",
      "imu-gaps",   "imu-rate",    "imu-order",      "imu-accel-scale", "imu-noise",     "clocks",
      "truth-span", "truth-time",  "dead-area",      "gravity",         "truth-frame"};
  return checks.count(fault.check) > 0;
}

TEST_P(DoctorFault, IsNamedFirstOrSecond) {
  Sample sick = GoodSample();
  GetParam().make(&sick);
  if (ShowsWithoutMap(GetParam())) sick.map = {};
  std::string said;
  const Findings found = ExamineSample(sick);
  EXPECT_TRUE(IsNamed(GetParam(), found, &said)) << said;
  std::set<std::string> wrong, good;
  for (const Finding& f : found) {
    if (f.severity != Severity::kGood) {
      wrong.insert(f.check);
    } else {
      EXPECT_TRUE(good.insert(f.check).second) << f.check << " is listed twice";
    }
  }
  for (const std::string& check : good) EXPECT_EQ(wrong.count(check), 0U) << check << " is good and wrong";
}

INSTANTIATE_TEST_SUITE_P(Doctor, DoctorFault, testing::ValuesIn(Faults()),
                         [](const auto& info) { return info.param.name; });

TEST(DoctorTest, AGoodRecordingHasNothingWrong) {
  for (const Finding& f : ExamineSample(GoodSample()))
    EXPECT_EQ(f.severity, Severity::kGood) << f.check << ": " << f.what << " (" << f.figure << ")";
}

// What is missing is the one thing that is wrong, and the rest is looked at all the same.
TEST(DoctorTest, WithoutImuOrEventsTheRestIsExamined) {
  Sample no_imu = GoodSample(), no_events = GoodSample();
  no_imu.imu.clear();
  no_events.events = {};
  for (const auto& [sample, missing, good] :
       {std::tuple(&no_imu, "imu-rate", "hot-pixels"), std::tuple(&no_events, "event-rate", "imu-noise")}) {
    bool examined = false;
    for (const Finding& f : ExamineSample(*sample)) {
      if (f.severity != Severity::kGood) {
        EXPECT_EQ(f.check, missing) << f.what;
        EXPECT_THAT(f.remedy, HasSubstr("evit import")) << f.check;
      }
      examined = examined || f.check == good;
    }
    EXPECT_TRUE(examined) << good;
  }
}

TEST(DoctorTest, WithoutMapAndTruthARecordingHasNothingWrong) {
  Patient patient;
  patient.log = test::SourcePath("logs/sample.lcmlog");
  patient.rig = test::SourcePath("logs/rig.textproto");
  for (const bool map : {false, true}) {
    if (map) patient.map = test::SourcePath("logs/sample_map.pcd");
    for (const Finding& f : Examine(patient, [](double) {}))
      EXPECT_EQ(f.severity, Severity::kGood) << f.check << ": " << f.what << " (" << f.figure << ")";
  }
}

TEST(DoctorTest, SaysWhatItCouldNotCheck) {
  Patient patient;
  EXPECT_THAT(NotChecked(patient), AllOf(HasSubstr("--map"), HasSubstr("--truth")));
  patient.map = "map.pcd";
  EXPECT_THAT(NotChecked(patient), AllOf(HasSubstr("extrinsics"), HasSubstr("--initial-pose")));
  patient.truth = "truth.tum";
  EXPECT_EQ(NotChecked(patient), "");
}

// A repeated stamp is passed over and told; all else is examined.
TEST(DoctorTest, RowsOfTheTruthThatCannotBeUsedAreTold) {
  const TemporaryFolder folder("doctor_truth");
  std::ifstream truth(test::SourcePath("logs/sample_truth.tum"));
  std::string text, line;
  for (int n = 0; std::getline(truth, line); ++n) text += line + "\n" + (n == 20 ? line + "\n" : "");
  Patient patient;
  patient.log = test::SourcePath("logs/sample.lcmlog");
  patient.rig = test::SourcePath("logs/rig.textproto");
  patient.truth = folder.Write("truth.tum", text);
  for (const Finding& f : Examine(patient, [](double) {}))
    EXPECT_EQ(f.severity, f.check == "truth-order" ? Severity::kWarning : Severity::kGood)
        << f.check << f.figure;
}

Severity SeverityOf(const std::vector<Finding>& findings, const std::string& check) {
  for (const Finding& f : findings)
    if (f.check == check) return f.severity;
  ADD_FAILURE() << "no check " << check;
  return Severity::kGood;
}

// At 10 Hz a pixel noise has company by chance within 10 ms, nearly always; edges that move have at once.
TEST(DoctorTest, NoiseOfAnyRateIsToldFromEdges) {
  constexpr int kSize = 100;
  for (const double hz : {0.5, 3.0, 12.0}) {
    for (const bool noise : {true, false}) {
      std::mt19937 rng(1);
      diagnosis::EventCensus census(kSize, kSize);
      EventArray events;
      const int n = static_cast<int>(2 * hz * kSize * kSize);
      for (int k = 0; k < n; ++k) {
        const Utime t = Utime{2'000'000} * k / n;
        const int edge = static_cast<int>(t / 10'000) % kSize;  // a column that moves on by a pixel in 10 ms
        events.push_back(t, static_cast<std::uint16_t>(noise ? static_cast<int>(rng() % kSize) : edge),
                         static_cast<std::uint16_t>(rng() % kSize), static_cast<std::uint8_t>(rng() % 2));
      }
      census.Add(events);
      EXPECT_EQ(SeverityOf(diagnosis::CheckEvents(census), "event-noise") == Severity::kGood, !noise) << hz;
    }
  }
}

// Where events are lost the event rate says nothing of the motion, though the camera rested half a second
// later.
TEST(DoctorTest, LostEventsAreNoOffsetOfClocks) {
  diagnosis::EventCensus census(64, 64);
  EventArray events;
  std::vector<ImuSample> imu;
  for (Utime t = 0; t < 3'000'000; t += 1000) {
    const bool lost = t > 900'000 && t<1'200'000, rests = t> 1'400'000 && t < 1'700'000;
    imu.push_back({t, {rests ? 0.02 : 1, 0, 0}, {0, 0, 9.81}});
    for (int k = 0; k < 100 && !lost; ++k)
      events.push_back(t + k, static_cast<std::uint16_t>(k % 64), static_cast<std::uint16_t>(k / 3 % 64),
                       k % 2);
  }
  census.Add(events);
  EXPECT_EQ(SeverityOf(diagnosis::CheckClocks(census, {}, imu, 0), "time-offset"), Severity::kGood);
  EXPECT_EQ(SeverityOf(diagnosis::CheckEvents(census), "event-gaps"), Severity::kWarning);
}

// Each sample counts once, however many of its axes are cut off.
TEST(DoctorTest, TimeAtTheLimitIsAtMostAllOfIt) {
  std::vector<ImuSample> samples;
  samples.reserve(600);
  for (int k = 0; k < 600; ++k) samples.push_back({Utime{5000} * k, {4, 4, 4}, {0, 0, 9.81}});
  for (const Finding& f : diagnosis::CheckImu(samples, GoodSample().rig)) {
    if (f.check == "imu-saturation") {
      EXPECT_THAT(f.what, HasSubstr("100.0 %")) << f.figure;
    }
  }
}

// One pixel in 25 is hot, and of the others each third has fired once: none of the rest is dead for that.
TEST(DoctorTest, AHotPixelDoesNotMakeItsNeighboursDead) {
  constexpr int kSize = 64, kHot = 500;
  diagnosis::EventCensus census(kSize, kSize);
  EventArray events;
  Utime t = 0;
  for (int round = 0; round < kHot; ++round) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        if ((x % 5 == 2 && y % 5 == 2) || (round == 0 && (x + y) % 3 == 0))
          events.push_back(t += 10, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), round % 2);
      }
    }
  }
  census.Add(events);
  bool found = false;
  for (const Finding& f : diagnosis::CheckEvents(census)) {
    if (f.check != "dead-pixels") continue;
    found = true;
    EXPECT_EQ(f.severity, Severity::kGood) << f.figure;
  }
  EXPECT_TRUE(found);
}

// Shaken by 2 g at 7 Hz it reads more than gravity most of the time, but not on average; a wrong scale does.
TEST(DoctorTest, ShakingIsNoOtherUnit) {
  for (const double scale : {1.0, 1.4}) {
    std::vector<ImuSample> samples;
    samples.reserve(600);
    for (int k = 0; k < 600; ++k)
      samples.push_back(
          {Utime{5000} * k, {0, 0, 0.1}, scale * Eigen::Vector3d(20 * std::sin(0.22 * k), 0, 9.81)});
    bool found = false;
    for (const Finding& f : diagnosis::CheckImu(samples, GoodSample().rig)) {
      if (f.check != (scale == 1 ? "imu-accel-unit" : "imu-accel-scale")) continue;
      found = true;
      EXPECT_EQ(f.severity, scale == 1 ? Severity::kGood : Severity::kError) << f.figure;
    }
    EXPECT_TRUE(found);
  }
}

// Linear acceleration of a rig that is shaken so hard that half of the readings are as large as gravity.
TEST(DoctorTest, ShakingIsNoGravity) {
  std::vector<ImuSample> samples;
  samples.reserve(600);
  for (int k = 0; k < 600; ++k)
    samples.push_back({Utime{5000} * k, {0, 0, 0.1}, {14 * std::sin(0.22 * k), 0, 0}});
  const diagnosis::Findings found = diagnosis::CheckImu(samples, GoodSample().rig);
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Finding& f) {
    return f.check == "imu-accel-unit" && f.severity == Severity::kError;
  }));
}

TEST(DoctorTest, ASizeToldFromEventsIsAtLeastThat) {
  diagnosis::EventCensus census(640, 480);
  EventArray events;
  for (int k = 0; k < 200'000; ++k)
    events.push_back(Utime{10} * k, static_cast<std::uint16_t>(k % 322),
                     static_cast<std::uint16_t>(k / 7 % 243), k % 2);
  census.Add(events);
  for (const Finding& f : diagnosis::CheckEvents(census)) {
    if (f.check != "sensor-size") continue;
    EXPECT_THAT(f.remedy, AllOf(HasSubstr("at least 322x243"), HasSubstr("346x260")));
  }
}

TEST(DoctorTest, SaysWhichFileIsMissing) {
  Patient patient;
  patient.log = "/nonexistent.lcmlog", patient.rig = test::SourcePath("logs/rig.textproto");
  EXPECT_THAT([&patient] { Examine(patient, [](double) {}); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("/nonexistent.lcmlog")));
}

}  // namespace
}  // namespace evit::doctor
