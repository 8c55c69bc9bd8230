#include "tools/locate/search_trace.h"

#include <gtest/gtest.h>

namespace evit::locate {
namespace {

constexpr Utime kBegin = 10'000'000;

PlaceCandidate At(double x, double significance) {
  return {SE3(Eigen::Quaterniond::Identity(), {x, 0, 0}), significance, 0, 500};
}

class SearchTraceTest : public ::testing::Test {
 protected:
  SearchTraceTest() {
    for (int k = 0; k < 40; ++k) truth_.push_back({kBegin + k * Utime{100'000}, SE3()});
    result_.begin = kBegin;
  }
  void Ask(double at, bool everywhere, const std::vector<PlaceCandidate>& candidates,
           const std::string& said) {
    result_.asked.push_back({kBegin + static_cast<Utime>(1e6 * at), everywhere,
                             Eigen::Vector3d(0, std::sin(0.1), std::cos(0.1)), candidates, said});
  }
  Trajectory truth_;
  LocatorResult result_;
};

TEST_F(SearchTraceTest, SaysWhatEachSearchCameTo) {
  Ask(0.5, true, {At(2, 4.1), At(0.01, 3.2)}, "places followed: 1");
  Ask(0.55, false, {At(2, 4)}, "places followed: 2");
  Ask(1, true, {At(0.02, 7.5)}, "found");
  EXPECT_EQ(TraceText(result_, truth_),
            "  at 0.50 s: searched, the vertical 5.7 deg off; places: 4.1 3.2 (right)\n"
            "  at 0.50 s: places followed: 1\n"
            "  at 1.00 s: searched, the vertical 5.7 deg off; places: 7.5 (right)\n"
            "  at 1.00 s: found\n");
}

TEST_F(SearchTraceTest, AClaimFromASingleKeyframeNeedsSignificanceAndALead) {
  EXPECT_EQ(AtOnce(result_, truth_), Claim::kNone);
  Ask(0.5, true, {At(2, 5.9)}, "");
  Ask(0.6, true, {At(2, 7), At(0, 5.5)}, "");
  EXPECT_EQ(AtOnce(result_, truth_), Claim::kNone);
  LocatorResult wrong = result_;
  Ask(0.7, true, {At(2, 4), At(0, 7)}, "");
  EXPECT_EQ(AtOnce(result_, truth_), Claim::kRight);
  std::swap(result_, wrong);
  Ask(0.7, true, {At(2, 7), At(0, 4)}, "");
  EXPECT_EQ(AtOnce(result_, truth_), Claim::kWrong);
}

}  // namespace
}  // namespace evit::locate
