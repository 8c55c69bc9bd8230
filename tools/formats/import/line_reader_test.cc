#include "tools/formats/import/line_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class LineReaderTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  LineReader Open(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return {path_, "t x"};
  }
  const std::string path_ = ::testing::TempDir() + "/lines_" + std::to_string(getpid()) + ".txt";
};

TEST_F(LineReaderTest, ReadsAllFormsOfLines) {
  LineReader lines = Open("# head\n\n1.5 -7\r\n  \t2,3e2\n#\n-0.000001 nan");
  Utime t = 0;
  ASSERT_TRUE(lines.Next());
  EXPECT_TRUE(lines.Time(&t));
  EXPECT_EQ(t, 1'500'000);
  EXPECT_EQ(lines.Integer(), -7);
  lines.End();
  ASSERT_TRUE(lines.Next());
  EXPECT_EQ(lines.Integer(), 2);
  EXPECT_EQ(lines.Number(), 300);
  ASSERT_TRUE(lines.Next());
  EXPECT_TRUE(lines.Time(&t));
  EXPECT_EQ(t, -1);
  EXPECT_TRUE(std::isnan(lines.Number()));
  EXPECT_FALSE(lines.Next());
  EXPECT_EQ(lines.share(), 1);
}

TEST_F(LineReaderTest, LinesAcrossBuffersStayWhole) {
  std::string text;
  constexpr int kLines = 300'000;  // some buffers
  for (int k = 0; k < kLines; ++k) text += std::to_string(k) + ".000001 " + std::to_string(3 * k) + "\n";
  LineReader lines = Open(text);
  for (int k = 0; k < kLines; ++k) {
    Utime t = 0;
    ASSERT_TRUE(lines.Next());
    ASSERT_TRUE(lines.Time(&t));
    ASSERT_EQ(t, k * kMicrosPerSecond + 1);
    ASSERT_EQ(lines.Integer(), 3 * k);
  }
  EXPECT_FALSE(lines.Next());
}

TEST_F(LineReaderTest, NamesFileLineAndLayout) {
  const auto read = [&](const std::string& line) {
    LineReader lines = Open("1 1\n# comment\n" + line);
    Utime t = 0;
    while (lines.Next()) {
      lines.Time(&t);
      lines.Integer();
      lines.End();
    }
  };
  for (const char* bad :
       {"1\n", "1.0e5 3\n", "one 3\n", "1 3.5\n", "1 3x\n", "1 3 4\n", "1 99999999999999999999\n"}) {
    EXPECT_THAT([&] { read(bad); }, ThrowsMessage<std::runtime_error>(HasSubstr(path_ + ":3: "))) << bad;
    EXPECT_THAT([&] { read(bad); }, ThrowsMessage<std::runtime_error>(HasSubstr("\"t x\""))) << bad;
  }
  EXPECT_THAT([&] { read(std::string(3 << 20, '7')); },
              ThrowsMessage<std::runtime_error>(HasSubstr("does not end")));
  EXPECT_THAT([] { LineReader("/no/such.txt", "t"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no such file")));
  EXPECT_THAT([] { LineReader("/tmp", "t"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("cannot be read")));
}

}  // namespace
}  // namespace evit::formats
