#include "common/files/table_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace evit {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class TableReaderTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  TableReader Open(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return {path_, "t x"};
  }
  const std::string path_ = ::testing::TempDir() + "/lines_" + std::to_string(getpid()) + ".txt";
};

TEST_F(TableReaderTest, ReadsAllFormsOfLines) {
  TableReader lines = Open("# head\n\n1.5 -7\r\n  \t2,3e2\n#\n-0.000001 nan");
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

TEST_F(TableReaderTest, ExponentsAreExactToTheMicrosecond) {
  TableReader lines = Open("1.642661138299999952e+09 +1.680000000000000000e+02\n2.7E-05 168.0\n1e999 1\n");
  Utime t = 0;
  ASSERT_TRUE(lines.Next());
  EXPECT_TRUE(lines.Time(&t));
  EXPECT_EQ(t, 1'642'661'138'300'000);
  EXPECT_EQ(lines.Integer(), 168);
  ASSERT_TRUE(lines.Next());
  EXPECT_TRUE(lines.Time(&t));
  EXPECT_EQ(t, 27);
  EXPECT_EQ(lines.Integer(), 168);
  ASSERT_TRUE(lines.Next());
  EXPECT_THROW(lines.Time(&t), std::runtime_error);
}

TEST_F(TableReaderTest, HeadsOfColumnsAreTold) {
  for (const char* text :
       {"t,x\n1,2\n", "# a table\n#t x\n\n1 2", "\xEF\xBB\xBF\"t\";\"x\"\r\n\"1\";\"2\"\r\n", "% t x\n1\t2\n",
        "// t x\r1 2\r", "; t x\n1 2 ; 3 rows follow\n"}) {
    TableReader lines = Open(text);
    ASSERT_TRUE(lines.Next()) << text;
    EXPECT_THAT(lines.head(), ::testing::ElementsAre("t", "x")) << text;
    EXPECT_EQ(lines.Integer(), 1) << text;
    EXPECT_EQ(lines.Integer(), 2) << text;
    EXPECT_EQ(lines.more(), text[0] == ';') << text;
    EXPECT_FALSE(lines.Next()) << text;
  }
  TableReader lines = Open("t x\n1 2\nnext part\n");  // between rows it is not a head
  ASSERT_TRUE(lines.Next());
  ASSERT_TRUE(lines.Next());
  EXPECT_THROW(lines.Number(), std::runtime_error);
}

TEST_F(TableReaderTest, CommentsBehindNumbersEndTheRow) {
  TableReader lines = Open("1 2 # two\n3 4 // two\n;5 6\n");
  for (int k = 0; k < 2; ++k) {
    ASSERT_TRUE(lines.Next());
    EXPECT_EQ(lines.WordsLeft(), 2U);
    lines.Number(), lines.Number();
    lines.End();
  }
  EXPECT_FALSE(lines.Next());
}

TEST_F(TableReaderTest, RowsMayEndWithCarriageReturnsAlone) {
  std::string text;
  constexpr int kRows = 200'000;  // some buffers
  for (int k = 0; k < kRows; ++k) text += std::to_string(k) + " 7\r";
  TableReader lines = Open(text);
  for (int k = 0; k < kRows; ++k) {
    ASSERT_TRUE(lines.Next());
    ASSERT_EQ(lines.Integer(), k);
    ASSERT_EQ(lines.Integer(), 7);
  }
  EXPECT_FALSE(lines.Next());
  EXPECT_EQ(lines.line(), kRows);
}

TEST_F(TableReaderTest, DecimalCommasAndUtf16AreRefused) {
  for (const char* text : {"0,31 0,29 0,23\n", "1;0,5\n", "0,1 -0,5\n"}) {
    EXPECT_THAT([&] { Open(text).Next(); }, ThrowsMessage<std::runtime_error>(HasSubstr("decimal commas")))
        << text;
  }
  for (const char* text : {"0.5,1 2,3\n", "1,2,3\n", "1, 2, 3\n", "1 2 3\n"})
    EXPECT_TRUE(Open(text).Next()) << text;
  EXPECT_THAT(
      [&] {
        Open(
            "\xFF\xFE"
            "1");
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("UTF-16")));
}

TEST_F(TableReaderTest, LinesAcrossBuffersStayWhole) {
  std::string text;
  constexpr int kLines = 300'000;  // some buffers
  for (int k = 0; k < kLines; ++k) text += std::to_string(k) + ".000001 " + std::to_string(3 * k) + "\n";
  TableReader lines = Open(text);
  for (int k = 0; k < kLines; ++k) {
    Utime t = 0;
    ASSERT_TRUE(lines.Next());
    ASSERT_TRUE(lines.Time(&t));
    ASSERT_EQ(t, k * kMicrosPerSecond + 1);
    ASSERT_EQ(lines.Integer(), 3 * k);
  }
  EXPECT_FALSE(lines.Next());
}

TEST_F(TableReaderTest, NamesFileLineAndLayout) {
  const auto read = [&](const std::string& line) {
    TableReader lines = Open("1 1\n# comment\n" + line);
    Utime t = 0;
    while (lines.Next()) {
      lines.Time(&t);
      lines.Integer();
      lines.End();
    }
  };
  for (const char* bad : {"1\n", "one 3\n", "1 3.5\n", "1 3x\n", "1 3 4\n", "1 99999999999999999999\n"}) {
    EXPECT_THAT([&] { read(bad); }, ThrowsMessage<std::runtime_error>(HasSubstr(path_ + ":3: "))) << bad;
    EXPECT_THAT([&] { read(bad); }, ThrowsMessage<std::runtime_error>(HasSubstr("\"t x\""))) << bad;
  }
  EXPECT_THAT([&] { read(std::string(3 << 20, '7')); },
              ThrowsMessage<std::runtime_error>(HasSubstr("does not end")));
  EXPECT_THAT([] { TableReader("/no/such.txt", "t"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no such file")));
  EXPECT_THAT([] { TableReader("/tmp", "t"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("cannot be read")));
}

}  // namespace
}  // namespace evit
