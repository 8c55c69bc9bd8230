#include "tools/doctor/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/paths.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/doctor/test_faults.h"

namespace evit::doctor {
namespace {

using diagnosis::Finding;
using diagnosis::Severity;
using ::testing::HasSubstr;

const Sample& GoodSample() {
  static const Sample sample =
      LoadSample(test::SourcePath("logs/sample.lcmlog"), test::SourcePath("logs/rig.textproto"),
                 test::SourcePath("logs/sample_map.pcd"), test::SourcePath("logs/sample_truth.tum"));
  return sample;
}

class DoctorFault : public testing::TestWithParam<Fault> {};

TEST_P(DoctorFault, IsNamedFirstOrSecond) {
  Sample sick = GoodSample();
  GetParam().make(&sick);
  std::string said;
  EXPECT_TRUE(IsNamed(GetParam(), ExamineSample(sick), &said)) << said;
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

TEST(DoctorTest, SaysWhichFileIsMissing) {
  Patient patient;
  patient.log = "/nonexistent.lcmlog", patient.rig = test::SourcePath("logs/rig.textproto");
  EXPECT_THAT([&patient] { Examine(patient, [](double) {}); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("/nonexistent.lcmlog")));
}

}  // namespace
}  // namespace evit::doctor
