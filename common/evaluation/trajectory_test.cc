// TUM files in and out, stamps without a lost microsecond, interpolation.
#include "common/evaluation/trajectory.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

namespace evit {
namespace {

class TumFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = ::testing::TempDir() + "evit_" + ::testing::UnitTest::GetInstance()->current_test_info()->name();
  }
  void TearDown() override { std::remove(path_.c_str()); }
  void Write(const std::string& text) const { std::ofstream(path_) << text; }
  // The complaint of ReadTum; empty where there is none.
  std::string Complaint(const std::string& text) const {
    Write(text);
    try {
      ReadTum(path_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  std::string path_;
};

TEST_F(TumFile, WhatIsWrittenReadsBack) {
  Trajectory written;
  for (int k = 0; k < 50; ++k) {
    written.push_back(
        {1'642'661'138'000'000 + Utime{k} * 8333, {ExpSO3({0.01 * k, -1, 0.3}), {k * 0.1, -2.0, 1e-4}}});
  }
  WriteTum(path_, written);
  const Trajectory read = ReadTum(path_);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    EXPECT_EQ(read[k].t, written[k].t);
    EXPECT_LT((read[k].pose.p - written[k].pose.p).norm(), 1e-8);
    EXPECT_LT(AngularDistance(read[k].pose.q, written[k].pose.q), 1e-7);
  }
}

TEST_F(TumFile, CommentsCommasAndBlankLinesAreFine) {
  EXPECT_EQ(Complaint("# t x y z qx qy qz qw\n\n1,0,0,0,0,0,0,1\n2 0 0 0 0 0 0 -1\n"), "");
  EXPECT_EQ(ReadTum(path_).size(), 2u);
}

TEST_F(TumFile, RepeatedAndBackwardStampsAreNamedAndSkipped) {
  std::string text;
  for (int k = 0; k < 100; ++k) {
    const int t = k == 40 ? 39 : k == 60 ? 20 : k == 80 ? 5000 : k;  // repeated, backward, far ahead
    text += std::to_string(t) + " " + std::to_string(k) + " 0 0 0 0 0 1\n";
  }
  std::ofstream(path_) << text;
  TumSkipped skipped;
  const Trajectory read = ReadTum(path_, &skipped);
  EXPECT_EQ(read.size(), 97U);
  EXPECT_EQ(skipped.rows, 3);
  EXPECT_NE(skipped.Text(path_).find("3 rows skipped, the first in line 41"), std::string::npos);
  EXPECT_EQ(read.back().pose.p.x(), 99);
  EXPECT_THROW(ReadTum(path_), std::runtime_error);  // nobody to tell
  std::ofstream(path_) << text << text;              // half of it: no slip
  EXPECT_THROW(ReadTum(path_, &skipped), std::runtime_error);
}

TEST_F(TumFile, RowsThatAreNotFiniteAreSkippedAndTold) {
  std::ofstream(path_) << "1 0 0 0 0 0 0 1\n2 nan nan nan 0 0 0 1\n3 0 0 0 nan nan nan nan\n4 0 0 0 0 0 0 1\n"
                       << "5 0 0 0 0 0 0 0\n";
  TumSkipped skipped;
  EXPECT_EQ(ReadTum(path_, &skipped).size(), 2U);
  EXPECT_EQ(skipped.rows, 3);
  EXPECT_EQ(skipped.first_line, 2);
}

TEST_F(TumFile, OrderOfTheQuaternionIsReadFromTheHead) {
  std::ofstream(path_) << "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
                          "q_RS_y [], q_RS_z []\n1642661138300000000,1,2,3,0.8,0.6,0,0\n";
  EXPECT_NEAR(ReadTum(path_)[0].pose.q.x(), 0.6, 1e-12);
}

TEST_F(TumFile, NanosecondsAndExponentsAreTold) {
  std::ofstream(path_) << "#timestamp [ns],x,y,z,qx,qy,qz,qw\n1642661138300000000,1,2,3,0,0,0,1\n";
  EXPECT_EQ(ReadTum(path_)[0].t, 1'642'661'138'300'000);
  std::ofstream(path_) << "1.642661138299999952e+09 1e0 2e0 3e0 0 0 0 1.0e+00\n";
  EXPECT_EQ(ReadTum(path_)[0].t, 1'642'661'138'300'000);
}

TEST_F(TumFile, ComplaintsNameFileLineAndFault) {
  const auto expect = [this](const std::string& text, const std::string& where, const std::string& what) {
    const std::string complaint = Complaint(text);
    EXPECT_NE(complaint.find(path_ + where), std::string::npos) << complaint;
    EXPECT_NE(complaint.find(what), std::string::npos) << complaint;
  };
  expect("1 0 0 0 0 0 0 1\n2 0 0 0\n", ":2", "ends too early");
  expect("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ":2", "does not increase");
  expect("1 0 0 0 0 0 0 0.5\n", ":1", "not of length 1");
  expect("1 0 0 0 0 0 0 0\n", ":1", "and a quaternion");
  expect("#\n1s 0 0 0 0 0 0 1\n", ":2", "not a time");
  expect("1 0 0 x 0 0 0 1\n", ":1", "not a number");
  expect("1 0 0 nan 0 0 0 1\n", ":1", "expected finite numbers");
  expect("# nothing\n", "", "contains no pose");
  EXPECT_THROW(ReadTum(path_ + ".absent"), std::runtime_error);
  EXPECT_THROW(WriteTum("/nonexistent/folder/a.tum", {}), std::runtime_error);
}

TEST(PoseAt, InterpolatesInsideAndRefusesOutsideAndHoles) {
  const Trajectory t{{0, {ExpSO3({0, 0, 0}), {0, 0, 0}}},
                     {100'000, {ExpSO3({0, 0, 0.2}), {1, 0, 0}}},
                     {900'000, {ExpSO3({0, 0, 0.4}), {2, 0, 0}}}};
  SE3 pose;
  ASSERT_TRUE(PoseAt(t, 25'000, &pose));
  EXPECT_NEAR(pose.p.x(), 0.25, 1e-12);
  EXPECT_NEAR(LogSO3(pose.q).z(), 0.05, 1e-12);
  ASSERT_TRUE(PoseAt(t, 0, &pose));
  ASSERT_TRUE(PoseAt(t, 900'000, &pose));
  EXPECT_NEAR(pose.p.x(), 2, 1e-12);
  EXPECT_FALSE(PoseAt(t, -1, &pose));
  EXPECT_FALSE(PoseAt(t, 900'001, &pose));
  EXPECT_FALSE(PoseAt(t, 500'000, &pose)) << "a hole of 0.8 s";
  EXPECT_TRUE(PoseAt(t, 500'000, &pose, 1'000'000));
}

}  // namespace
}  // namespace evit
