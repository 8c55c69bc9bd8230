#include "common/files/table_sample.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <utility>

namespace evit {
namespace {

class TableSampleTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  TableSample Sample(const std::string& text) const {
    std::ofstream(path_) << text;
    return SampleTable(path_, "t x");
  }
  const std::string path_ = ::testing::TempDir() + "/sample_" + std::to_string(getpid()) + ".txt";
};

TEST_F(TableSampleTest, KeepsHeadAndFirstRows) {
  const TableSample sample = Sample("# t x\n1 2\n3\n");
  EXPECT_EQ(sample.head, (std::vector<std::string>{"t", "x"}));
  EXPECT_EQ(sample.rows, (std::vector<std::vector<std::string>>{{"1", "2"}, {"3"}}));
}

TEST_F(TableSampleTest, UnitsBelongToTheNamesBeforeThem) {
  const auto columns = NamedColumns(Sample("#timestamp [ns],w_RS_S_x [rad s^-1],a(m/s^2),p\n5,1,2,3\n").head);
  ASSERT_EQ(columns.size(), 4U);
  EXPECT_EQ(columns[0].name, "timestamp");
  EXPECT_EQ(columns[0].unit, "[ns]");
  EXPECT_EQ(columns[1].name, "w_RS_S_x");
  EXPECT_EQ(columns[2].name, "a");
  EXPECT_EQ(columns[3].name, "p");
}

TEST_F(TableSampleTest, UnitOfStampsIsTold) {
  // Events: at most 10 ms apart.
  for (const auto& [text, unit] : {
           std::pair("0.000027 1\n0.000243 1\n", TimeUnit::kSeconds),
           std::pair("2.7e-05 1\n2.43e-04 1\n", TimeUnit::kSeconds),
           std::pair("1642661138.0 1\n1642661138.01 1\n", TimeUnit::kSeconds),
           std::pair("27 1\n243 1\n379 1\n", TimeUnit::kMicroseconds),
           std::pair("0 1\n0 1\n0 1\n0 1\n1 1\n", TimeUnit::kMicroseconds),
           std::pair("1642661138000027 1\n1642661138000243 1\n", TimeUnit::kMicroseconds),
           std::pair("1642661138000027000 1\n1642661138000243000 1\n", TimeUnit::kNanoseconds),
           std::pair("1642661138001 1\n1642661138004 1\n", TimeUnit::kMilliseconds),
           std::pair("1234567890 1\n1234567990 1\n", TimeUnit::kMicroseconds),
           std::pair("0 1\n20000 1\n40000 1\n", TimeUnit::kNanoseconds),
           std::pair("t_ns x\n0 1\n20 1\n40 1\n", TimeUnit::kNanoseconds),
           std::pair("#timestamp [ns],w [rad s^-1]\n5,1\n6,1\n", TimeUnit::kNanoseconds),
           std::pair("# time(ms) x\n5 1\n6 1\n", TimeUnit::kMilliseconds),
           std::pair("t[\xC2\xB5s],x\n5,1\n6,1\n", TimeUnit::kMicroseconds),
           std::pair("t (\xCE\xBCs),x\n5,1\n6,1\n", TimeUnit::kMicroseconds),
           std::pair("t_\xB5s,x\n5,1\n6,1\n", TimeUnit::kMicroseconds),
           std::pair("#timestamp x[ms]\n0.5 1\n0.6 1\n", TimeUnit::kSeconds),
       }) {
    EXPECT_EQ(UnitOfStamps(Sample(text), 0, 0.01), unit) << text;
  }
  // At a million events a second, no rate tells milliseconds from seconds, or nanoseconds from microseconds:
  // three decimals or zeros do.
  std::string milliseconds, nanoseconds, seconds;
  for (int k = 0; k < 20; ++k) {
    milliseconds += "0." + std::to_string(101 + k) + " 1\n";
    nanoseconds += std::to_string(7 + k) + "000 1\n";
    seconds += "0." + std::to_string(100'001 + k) + " 1\n";
  }
  EXPECT_EQ(UnitOfStamps(Sample(milliseconds), 0, 0.01), TimeUnit::kMilliseconds);
  EXPECT_EQ(UnitOfStamps(Sample(nanoseconds), 0, 0.01), TimeUnit::kNanoseconds);
  EXPECT_EQ(UnitOfStamps(Sample(seconds), 0, 0.01), TimeUnit::kSeconds);
  // An IMU of 1 kHz has such seconds and microseconds.
  EXPECT_EQ(UnitOfStamps(Sample(milliseconds), 0, 0.1), TimeUnit::kSeconds);
  EXPECT_EQ(UnitOfStamps(Sample(nanoseconds), 0, 0.1), TimeUnit::kMicroseconds);
  // A trajectory may well have one pose a second.
  EXPECT_EQ(UnitOfStamps(Sample("0 1\n1 1\n2 1\n"), 0, 5), TimeUnit::kSeconds);
  EXPECT_EQ(UnitOfStamps(Sample("0 1\n10000000 1\n20000000 1\n"), 0, 5), TimeUnit::kNanoseconds);
}

}  // namespace
}  // namespace evit
