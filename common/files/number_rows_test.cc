#include "common/files/number_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace evit {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class NumberRowsTest : public ::testing::Test {
 protected:
  NumberRowsTest()
      : path_(std::filesystem::temp_directory_path() / ("number_rows_" + std::to_string(getpid()))) {}
  ~NumberRowsTest() override { std::filesystem::remove(path_); }

  NumberRows Rows(const std::string& text) const {
    std::ofstream(path_) << text;
    return {path_, "t x y", "a table"};
  }

  std::filesystem::path path_;
};

TEST_F(NumberRowsTest, ReadsBlanksCommasAndComments) {
  NumberRows rows = Rows("# t x y\n\n1.5, 2,-3e2\n  7 8 9 # not read\n");
  ASSERT_TRUE(rows.Next());
  EXPECT_EQ(rows.first(), "1.5");
  EXPECT_EQ(rows.Number(), 2);
  EXPECT_TRUE(rows.more());
  EXPECT_EQ(rows.Number(), -300);
  EXPECT_FALSE(rows.more());
  ASSERT_TRUE(rows.Next());
  EXPECT_EQ(rows.first(), "7");
  EXPECT_FALSE(rows.Next());
}

TEST_F(NumberRowsTest, MissingAndNonFiniteNumbersNameLineAndLayout) {
  for (const char* text : {"1 2 3\n4\n", "1 2 3\n4 nan 5\n", "1 2 3\n4 1e999 5\n", "1 2 3\n4 x 5\n"}) {
    NumberRows rows = Rows(text);
    rows.Next();
    rows.Next();
    EXPECT_THAT([&] { rows.Number(); },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(":2: "), HasSubstr("t x y"))))
        << text;
  }
}

TEST_F(NumberRowsTest, UnreadableFileIsNamedWithItsKind) {
  EXPECT_THAT([] { NumberRows("/nowhere/table", "t x y", "a table"); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("/nowhere/table"), HasSubstr("a table"))));
}

}  // namespace
}  // namespace evit
