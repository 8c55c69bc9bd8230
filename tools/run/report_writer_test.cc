#include "tools/run/report_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/helpers/temporary_folder.h"

namespace evit::run {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr Utime kReportStart = 1'642'661'138'000'000;

SE3 ReportedPose(int k) { return {Eigen::Quaterniond::Identity(), {0.01 * k, 0, 1}}; }

TEST(ReportWriter, HoldsTheErrors) {
  const TemporaryFolder folder("report_writer");
  Trajectory truth, estimate;
  for (int k = 0; k <= 100; ++k) truth.push_back({kReportStart + Utime{10'000} * k, ReportedPose(k)});
  for (int k = 10; k <= 60; ++k) {
    SE3 pose = ReportedPose(k);
    pose.p.y() += 0.02;
    estimate.push_back({kReportStart + Utime{10'000} * k, pose});
  }
  report::Report report;
  report.set_lossless(true);
  FillErrors(truth, estimate, &report);
  WriteReport(folder.File("report.json"), report);
  nlohmann::json json;
  std::ifstream(folder.File("report.json")) >> json;
  EXPECT_EQ(json["lossless"], true);
  EXPECT_EQ(json["ate"][0]["alignment"], "none");
  EXPECT_NEAR(json["ate"][0]["all"]["position_rmse_cm"], 2, 1e-6);
  EXPECT_EQ(json["ate"][1]["alignment"], "first pair");
  EXPECT_NEAR(json["ate"][1]["all"]["position_rmse_cm"], 0, 1e-6);
  EXPECT_TRUE(json["ate"][0].contains("at_50_percent"));
  EXPECT_FALSE(json["ate"][0].contains("at_100_percent"));  // not reached
  EXPECT_THAT([&] { WriteReport(folder.File("no/report.json"), report); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no/report.json")));
}

TEST(ReportWriter, HasNoErrorOfTooFewPairs) {
  Trajectory truth, estimate;
  for (int k = 0; k <= 100; ++k) estimate.push_back({kReportStart + Utime{10'000} * k, ReportedPose(k)});
  truth = {estimate[0], estimate[80]};
  report::Report report;
  FillErrors(truth, estimate, &report);
  EXPECT_EQ(report.ate_size(), 0);
  EXPECT_THAT(report.not_scored(), HasSubstr("only 2 pairs"));
}

TEST(ReportWriter, HoldsTheConsistency) {
  const TemporaryFolder folder("report_writer");
  Trajectory truth, estimate;
  Covariances covariances;
  for (int k = 0; k <= 100; ++k) {
    const Utime t = kReportStart + Utime{10'000} * k;
    truth.push_back({t, ReportedPose(k)});
    SE3 pose = ReportedPose(k);
    pose.p.y() += 0.02;
    estimate.push_back({t, pose});
    covariances.push_back({t, 1e-4 * Matrix6d::Identity()});
  }
  const Consistency consistency = ConsistencyOf(truth, estimate, covariances);
  report::Report report;
  FillConsistency(consistency, &report);
  WriteReport(folder.File("report.json"), report);
  nlohmann::json json;
  std::ifstream(folder.File("report.json")) >> json;
  EXPECT_NEAR(json["consistency"]["position_nees"]["mean_per_dof"], 4.0 / 3, 1e-6);  // 2 cm at 1 cm sigma
  EXPECT_NEAR(json["consistency"]["orientation_nees"]["mean"], 0, 1e-6);
  EXPECT_EQ(json["consistency"]["pose_nees"]["dof"], 6);
  EXPECT_EQ(json["consistency"]["pose_nees"]["share_within_95"], 1);
}

}  // namespace
}  // namespace evit::run
