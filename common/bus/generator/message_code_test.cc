#include "common/bus/generator/message_code.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace evit::generator {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kPoint[] = "package p;\n\nstruct point_t {\n  double xyz[3];  // m\n  int8_t kind;\n}\n";
constexpr char kCloud[] = R"(package p;

// A comment.
struct cloud_t {
  const int8_t SPARSE = 0, DENSE = 1;
  int64_t utime;      // us
  string name;
  int32_t n;          // points, at most 500
  point_t point[n];
  float weight[n][2];
  int32_t n_tags;     // at most 7
  string tag[n_tags];
  byte image[n][n_tags];
  point_t origin;
}
)";

std::vector<MessageType> Types(const std::string& cloud) {
  return {ParseLcm(cloud, "cloud_t.lcm"), ParseLcm(kPoint, "point_t.lcm")};
}

/// The cloud with `from` replaced.
std::vector<MessageType> Changed(const std::string& from, const std::string& to) {
  std::string text = kCloud;
  text.replace(text.find(from), from.size(), to);
  return Types(text);
}

template <typename Function>
std::string ErrorOf(const Function& function) {
  try {
    function();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MessageCode, LayoutFollowsTheFieldsInOrder) {
  EXPECT_THAT(LayoutsSource(Types(kCloud)),
              HasSubstr("LayoutOf<p::cloud_t>() {\n  static const WireLayout layout = {"
                        "Bytes(8), Text(\"name\"), Count(\"n\", 500), Array(25, \"n\"), Array(8, \"n\"), "
                        "Count(\"n_tags\", 7), Text(\"tag\", \"n_tags\"), Array(1, \"n\", \"n_tags\"), "
                        "Bytes(25)};"));
}

TEST(MessageCode, ElementsWithTextBecomeAGroup) {
  const std::string source =
      LayoutsSource({ParseLcm("package p;\nstruct a_t {\n  int32_t n; // at most 3\n  b_t b[n];\n}\n", "a"),
                     ParseLcm("package p;\nstruct b_t {\n  int16_t x;\n  string s;\n}\n", "b")});
  EXPECT_THAT(source, HasSubstr("fields = {Bytes(2), Text(\"b.s\")};"));
  EXPECT_THAT(source, HasSubstr("layout = {Count(\"n\", 3), Group(&b_t_of_a_t(), \"n\")};"));
}

TEST(MessageCode, TypesInsideOthersAreNoMessages) {
  const std::string header = MessagesHeader(Types(kCloud));
  EXPECT_THAT(header, HasSubstr("X(cloud_t)"));
  EXPECT_THAT(header, HasSubstr("#include \"p/cloud_t.hpp\""));
  EXPECT_THAT(header, HasSubstr("using AllMessages = List<cloud_t>;"));
  EXPECT_THAT(header, Not(HasSubstr("X(point_t)")));
}

TEST(MessageCode, EveryCountedArrayIsVisitedWithItsRows) {
  const std::string header = MessagesHeader(Types(kCloud));
  EXPECT_THAT(header, HasSubstr("visit(\"point\", m.n, m.point);"));
  EXPECT_THAT(header, HasSubstr("for (auto& row : m.weight) visit(\"weight[i]\", 2, row);"));
  EXPECT_THAT(header, HasSubstr("for (auto& row : m.image) visit(\"image[i]\", m.n_tags, row);"));
  EXPECT_THAT(header, Not(HasSubstr("xyz")));
}

TEST(MessageCode, ACountWithoutALimitIsAnError) {
  EXPECT_EQ(ErrorOf([] { LayoutsSource(Changed("points, at most 500", "points")); }),
            "cloud_t.lcm:8: n counts an array: its comment has to say \"at most NUMBER\"");
}

TEST(MessageCode, WhatTheChecksCannotDoIsAnError) {
  EXPECT_THAT(ErrorOf([] { LayoutsSource(Changed("int32_t n;", "int64_t n;")); }), HasSubstr("int32_t"));
  EXPECT_THAT(ErrorOf([] { LayoutsSource(Changed("weight[n][2]", "weight[2][n]")); }),
              HasSubstr("cloud_t.lcm:10: weight may have counted dimensions only first"));
  EXPECT_THAT(ErrorOf([] { LayoutsSource(Changed("float weight", "matrix_t weight")); }),
              HasSubstr("unknown type matrix_t"));
  const std::string list = "package p;\nstruct point_t {\n  int32_t n; // at most 2\n  byte b[n];\n}\n";
  EXPECT_THAT(ErrorOf([&] {
                LayoutsSource({ParseLcm(kCloud, "c"), ParseLcm(list, "point_t.lcm")});
              }),
              HasSubstr("point_t.lcm:3: n counts an array inside another type"));
}

TEST(LcmFile, WhatItDoesNotReadIsAnErrorWithItsLine) {
  EXPECT_EQ(ErrorOf([] { ParseLcm("package p;\nstruct a_t {\n  double x, y;\n}\n", "a.lcm"); }),
            "a.lcm:3: expected \"TYPE NAME;\" or \"TYPE NAME[DIMENSION];\": double x, y;");
  EXPECT_THAT(ErrorOf([] { ParseLcm("struct a_t {\n}\n", "a.lcm"); }), HasSubstr("a.lcm:1: expected"));
  EXPECT_THAT(ErrorOf([] { ParseLcm("package p;\nstruct a_t {\n  double x;\n", "a.lcm"); }),
              HasSubstr("a.lcm: the struct has no end"));
}

}  // namespace
}  // namespace evit::generator
