#include "common/tracking/start_probation.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

constexpr Utime kBegin = 5'000'000;

TEST(StartProbation, FiveKeyframesThatHardlyFitTellAFalseStart) {
  StartProbation probation;
  probation.Begin(kBegin);
  for (int k = 0; k < 4; ++k) probation.Add(1);
  EXPECT_EQ(probation.WhyFalse(kBegin + 100'000), "");  // too few to say
  EXPECT_FALSE(probation.Passed());
  probation.Add(1);
  EXPECT_NE(probation.WhyFalse(kBegin + 125'000), "");
  EXPECT_FALSE(probation.Passed());
}

TEST(StartProbation, IsPassedByFiveThatFit) {
  StartProbation probation;
  probation.Begin(kBegin);
  for (int k = 0; k < 5; ++k) probation.Add(6);
  EXPECT_TRUE(probation.Passed());
  EXPECT_EQ(probation.WhyFalse(kBegin + 125'000), "");
  for (int k = 0; k < 50; ++k) probation.Add(1);
  EXPECT_NE(probation.WhyFalse(kBegin + 900'000), "");
  EXPECT_TRUE(probation.Passed());
  probation.Begin(kBegin + 2'000'000);  // the next start begins from nothing
  EXPECT_FALSE(probation.Passed());
  probation.Add(1);
  EXPECT_EQ(probation.WhyFalse(kBegin + 2'025'000), "");
}

TEST(StartProbation, TimeAloneEndsItButProvesNothing) {
  StartProbation probation;
  probation.Begin(kBegin);
  for (int k = 0; k < 10; ++k) probation.Add(1);
  EXPECT_EQ(probation.WhyFalse(kBegin + 1'000'001), "");
  EXPECT_FALSE(probation.Passed());
}

TEST(StartProbation, AKnownStateHasNothingToProve) {
  StartProbation probation;
  probation.Begin(kBegin);
  probation.Skip();
  for (int k = 0; k < 10; ++k) probation.Add(0);
  EXPECT_TRUE(probation.Passed());
  EXPECT_EQ(probation.WhyFalse(kBegin + 1), "");
}

}  // namespace
}  // namespace evit
