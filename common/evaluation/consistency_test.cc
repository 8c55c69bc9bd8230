// Errors drawn from covariances that are known.
#include "common/evaluation/consistency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Cholesky>
#include <fstream>
#include <random>

namespace evit {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kPoses = 4000;

struct Case {
  Trajectory truth, estimate;
  Covariances covariances;
};

// The truth is the estimate moved by what its covariance allows: some millimetres and milliradians,
// correlated, other ones for each pose.
Case Draw(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Case c;
  for (int k = 0; k < kPoses; ++k) {
    const Utime t = 1'000'000 + Utime{10'000} * k;
    const SE3 pose{ExpSO3({std::sin(0.01 * k), 0.5, 0.02 * k}), {0.001 * k, 2, std::cos(0.03 * k)}};
    const Matrix6d A = Matrix6d::NullaryExpr([&] { return 2e-3 * normal(random); });
    const Matrix6d P = A * A.transpose() + 1e-6 * Matrix6d::Identity();
    const Eigen::Matrix<double, 6, 1> z =
        Eigen::Matrix<double, 6, 1>::NullaryExpr([&] { return normal(random); });
    const Matrix6d L = P.llt().matrixL();
    c.estimate.push_back({t, pose});
    c.truth.push_back({t, pose.Plus(L * z)});
    c.covariances.push_back({t, P});
  }
  return c;
}

void ExpectPerDof(const Consistency& c, double value) {
  for (const Nees* nees : {&c.position, &c.orientation, &c.pose}) {
    ASSERT_EQ(nees->n, kPoses);
    // The mean of n chi-square variables with d dof has the standard deviation sqrt(2 d / n): allow five.
    EXPECT_NEAR(nees->mean_per_dof(), value, 5 * value * std::sqrt(2.0 / (nees->dof * kPoses)));
  }
}

TEST(Consistency, OfHonestCovariancesIsOne) {
  const Case c = Draw(1);
  const Consistency consistency = ConsistencyOf(c.truth, c.estimate, c.covariances);
  ExpectPerDof(consistency, 1);
  for (const Nees* nees : {&consistency.position, &consistency.orientation, &consistency.pose}) {
    EXPECT_NEAR(nees->share_in_95, 0.95, 5 * std::sqrt(0.95 * 0.05 / kPoses));
  }
  EXPECT_NEAR(consistency.position.median, 2.366, 0.2);  // chi-square's medians
  EXPECT_NEAR(consistency.pose.median, 5.348, 0.3);
}

TEST(Consistency, ScaledCovariancesGiveTheScaledValue) {
  Case c = Draw(2);
  for (StampedCovariance& s : c.covariances) s.covariance /= 9;  // sigmas three times too small
  const Consistency consistency = ConsistencyOf(c.truth, c.estimate, c.covariances);
  ExpectPerDof(consistency, 9);
  EXPECT_LT(consistency.pose.share_in_95, 0.3);
}

TEST(Consistency, OnePartTooSureShowsInThatPart) {
  Case c = Draw(3);
  for (StampedCovariance& s : c.covariances) {
    s.covariance.bottomRows<3>() /= 2;
    s.covariance.rightCols<3>() /= 2;
  }
  const Consistency consistency = ConsistencyOf(c.truth, c.estimate, c.covariances);
  EXPECT_NEAR(consistency.position.mean_per_dof(), 1, 0.1);
  EXPECT_NEAR(consistency.orientation.mean_per_dof(), 4, 0.4);
}

TEST(Consistency, ErrorIsInTheFramesOfTheCovariance) {
  const SE3 estimate{ExpSO3({0, 0, EIGEN_PI / 2}), {1, 2, 3}};
  Eigen::Matrix<double, 6, 1> d;
  d << 0.01, 0, 0, 0.02, 0, 0;  // x of the map, x of the body
  StampedCovariance P{5, Matrix6d::Identity()};
  P.covariance(0, 0) = 1e-4;
  P.covariance(3, 3) = 4e-4;
  const Consistency c = ConsistencyOf({{5, estimate.Plus(d)}}, {{5, estimate}}, {P});
  EXPECT_NEAR(c.position.mean, 1, 1e-9);
  EXPECT_NEAR(c.orientation.mean, 1, 1e-9);
  EXPECT_NEAR(c.pose.mean, 2, 1e-9);
  ASSERT_EQ(c.errors.size(), 1U);
  EXPECT_LT((c.errors[0].error - d).norm(), 1e-12);
  EXPECT_NEAR(c.errors[0].sigma[3], 0.02, 1e-12);
}

TEST(Consistency, PosesWithoutCovarianceAreCountedNotScored) {
  Case c = Draw(4);
  for (int k = 0; k < 100; ++k) c.covariances[k].covariance.setZero();
  c.covariances.erase(c.covariances.begin() + 200, c.covariances.begin() + 230);
  const Consistency consistency = ConsistencyOf(c.truth, c.estimate, c.covariances);
  EXPECT_EQ(consistency.without_covariance, 130);
  EXPECT_EQ(consistency.pose.n, kPoses - 130);
  EXPECT_NEAR(consistency.pose.mean_per_dof(), 1, 0.1);
  EXPECT_THAT(ConsistencyText(ConsistencyOf(c.truth, c.estimate, {})), HasSubstr("no pose has"));
}

class CovarianceFile : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  void Write(const std::string& text) const { std::ofstream(path_) << text; }
  const std::string path_ = ::testing::TempDir() + "covariance_" + std::to_string(getpid()) + ".csv";
};

TEST_F(CovarianceFile, ReadsWhatItWrote) {
  Covariances all = Draw(5).covariances;
  all.resize(20);
  all[3].covariance.setZero();
  WriteCovariances(path_, all);
  const Covariances read = ReadCovariances(path_);
  all.erase(all.begin() + 3);  // without a covariance: left out, where zeros would pass for an exact pose
  ASSERT_EQ(read.size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(read[k].t, all[k].t);
    EXPECT_LT((read[k].covariance - all[k].covariance).norm(), 1e-8 * (1e-9 + all[k].covariance.norm()));
  }
}

TEST_F(CovarianceFile, SaysWhatIsWrongAndWhere) {
  const std::string row = "1,1,0,0,0,0,0,1,0,0,0,0,1,0,0,0,1,0,0,1,0,1\n";
  const auto expect = [&](const std::string& text, const std::string& what) {
    Write(text);
    EXPECT_THAT([&] { ReadCovariances(path_); },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path_), HasSubstr(what))));
  };
  Write(row);
  EXPECT_EQ(ReadCovariances(path_)[0].covariance, Matrix6d::Identity());
  expect("", "no covariance");
  expect(row + "2,1,0\n", ":2: the line ends too early");
  expect(row + row, ":2: the time does not increase");
  expect("1.5" + row.substr(1), "1.5\" is not a whole number");
  expect("1,nan" + row.substr(3), "expected");
  expect(row.substr(0, row.size() - 1) + ",7\n", "more than");
  EXPECT_THAT([] { ReadCovariances("/none/c.csv"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/none/c.csv")));
  EXPECT_THAT([] { WriteCovariances("/none/c.csv", {}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/none/c.csv")));
}

}  // namespace
}  // namespace evit
