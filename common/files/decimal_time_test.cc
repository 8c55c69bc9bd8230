#include "common/files/decimal_time.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace evit {
namespace {

TEST(DecimalTimeTest, EveryMicrosecondOfTodaysDatesSurvives) {
  for (Utime t = 1'642'661'138'836'530; t < 1'642'661'138'836'630; ++t) {
    Utime back = 0;
    ASSERT_TRUE(ParseDecimalTime(DecimalSeconds(t), TimeUnit::kSeconds, &back));
    ASSERT_EQ(back, t);
  }
}

TEST(DecimalTimeTest, SignsAndPointsAreReadAndOtherTextRefused) {
  const auto parse = [](const std::string& text) {
    Utime t = 0;
    EXPECT_TRUE(ParseDecimalTime(text, TimeUnit::kSeconds, &t)) << text;
    return t;
  };
  EXPECT_EQ(parse("12"), 12'000'000);
  EXPECT_EQ(parse("0.5"), 500'000);
  EXPECT_EQ(parse(".25"), 250'000);
  EXPECT_EQ(parse("-1.5"), -1'500'000);
  EXPECT_EQ(parse("+3."), 3'000'000);
  EXPECT_EQ(parse("1.0000004"), 1'000'000);
  EXPECT_EQ(parse("1.0000005"), 1'000'001);
  EXPECT_EQ(parse("0.9999999"), 1'000'000);
  EXPECT_EQ(DecimalSeconds(-1'500'000), "-1.500000");
  for (const char* bad : {"", "-", ".", "1.2.3", "abc", "12s", "1234567890123", "nan"}) {
    Utime t = 0;
    EXPECT_FALSE(ParseDecimalTime(bad, TimeUnit::kSeconds, &t)) << bad;
  }
}

TEST(DecimalTimeTest, EveryFormIsExact) {
  for (const auto& [text, micros] :
       {std::pair("1642661138.836530", Utime{1'642'661'138'836'530}), std::pair("12", Utime{12'000'000}),
        std::pair("-0.5", Utime{-500'000}), std::pair("+1.5e0", Utime{1'500'000}),
        std::pair(".25", Utime{250'000}), std::pair("1.642661138299999952e+09", Utime{1'642'661'138'300'000}),
        std::pair("2.7e-05", Utime{27}), std::pair("0.0000005", Utime{1}), std::pair("0.0000004", Utime{0}),
        std::pair("0e5", Utime{0}),
        std::pair("0.000000000000000000000000000000000000000000000000001e45", Utime{1}),
        std::pair("3.5e1", Utime{35'000'000})}) {
    Utime t = -7;
    EXPECT_TRUE(ParseDecimalTime(text, TimeUnit::kSeconds, &t)) << text;
    EXPECT_EQ(t, micros) << text;
  }
  for (const char* text : {"", ".", "-", "1.2.3", "1e", "1e+", "e5", "1e99999", "1e20", "nan", "0x1", "1 "}) {
    Utime t = 0;
    EXPECT_FALSE(ParseDecimalTime(text, TimeUnit::kSeconds, &t)) << text;
  }
}

TEST(DecimalTimeTest, UnitsScaleWithoutLoss) {
  Utime t = 0;
  EXPECT_TRUE(ParseDecimalTime("1642661138000000499", TimeUnit::kNanoseconds, &t));
  EXPECT_EQ(t, 1'642'661'138'000'000);
  EXPECT_TRUE(ParseDecimalTime("1642661138000000.5", TimeUnit::kMicroseconds, &t));
  EXPECT_EQ(t, 1'642'661'138'000'001);
  EXPECT_TRUE(ParseDecimalTime("1642661138000.25", TimeUnit::kMilliseconds, &t));
  EXPECT_EQ(t, 1'642'661'138'000'250);
}

TEST(DecimalTimeTest, DatesTellTheirUnit) {
  EXPECT_EQ(UnitOfDate("1642661138.5"), TimeUnit::kSeconds);
  EXPECT_EQ(UnitOfDate("1.6426611385e9"), TimeUnit::kSeconds);
  EXPECT_EQ(UnitOfDate("1642661138500"), TimeUnit::kMilliseconds);
  EXPECT_EQ(UnitOfDate("1642661138500000"), TimeUnit::kMicroseconds);
  EXPECT_EQ(UnitOfDate("1642661138500000000"), TimeUnit::kNanoseconds);
  EXPECT_EQ(UnitOfDate("0.25"), std::nullopt);
  EXPECT_EQ(UnitOfDate("500000"), std::nullopt);
}

}  // namespace
}  // namespace evit
