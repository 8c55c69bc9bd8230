#include "tools/monitor/page_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace evit::monitor {
namespace {

using ::testing::HasSubstr;

std::string Refusal(const std::string& text) {
  try {
    ParsePageOrder(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(PageOrder, KnownOrdersAreRead) {
  EXPECT_EQ(ParsePageOrder(R"({"order":"restart","command":"map_server"})").command, "map_server");
  EXPECT_EQ(ParsePageOrder(R"({"order":"pause"})").kind, PageOrder::Kind::kPause);
  EXPECT_EQ(ParsePageOrder(R"({"order":"resume"})").kind, PageOrder::Kind::kResume);
  EXPECT_EQ(ParsePageOrder(R"({"order":"seek","share":0.25})").seek_share, 0.25);
  EXPECT_EQ(ParsePageOrder(R"({"order":"speed","speed":2})").speed, 2);
  EXPECT_FALSE(ParsePageOrder(R"({"order":"drawn"})").changes_pipeline());
  EXPECT_EQ(ParsePageOrder(R"({"order":"drawn","utime":1642516764984000})").drawn_utime, 1642516764984000);
}

TEST(PageOrder, AHintIsAPose) {
  const PageOrder order =
      ParsePageOrder(R"({"order":"hint","position":[1,2,3],"orientation":[0,0,0.7071,0.7071]})");
  EXPECT_EQ(order.kind, PageOrder::Kind::kHint);
  EXPECT_EQ(order.T_map_body.p, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(order.T_map_body.q.norm(), 1, 1e-12);
}

TEST(PageOrder, AnythingElseIsRefusedAndSaysWhy) {
  EXPECT_THAT(Refusal(""), HasSubstr("no JSON object"));
  EXPECT_THAT(Refusal("[1,2"), HasSubstr("no JSON object"));
  EXPECT_THAT(Refusal("{}"), HasSubstr("order is missing"));
  EXPECT_THAT(Refusal(R"({"order":"exec","command":"rm"})"), HasSubstr("unknown"));
  EXPECT_THAT(Refusal(R"({"order":7})"), HasSubstr("unknown"));
  EXPECT_THAT(Refusal(R"({"order":"restart","command":["a"]})"), HasSubstr("not a name"));
  EXPECT_THAT(Refusal(R"({"order":"seek","share":1.5})"), HasSubstr("out of range"));
  EXPECT_THAT(Refusal(R"({"order":"speed","speed":0})"), HasSubstr("out of range"));
  EXPECT_THAT(Refusal(R"({"order":"speed","speed":"fast"})"), HasSubstr("not a number"));
  EXPECT_THAT(Refusal(R"({"order":"hint","position":[1,2],"orientation":[0,0,0,1]})"),
              HasSubstr("position has a wrong length"));
  EXPECT_THAT(Refusal(R"({"order":"hint","position":[1,2,1e300],"orientation":[0,0,0,1]})"),
              HasSubstr("position is out of range"));
  EXPECT_THAT(Refusal(R"({"order":"hint","position":[1,2,3],"orientation":[0,0,0,0.5]})"),
              HasSubstr("not a unit quaternion"));
  EXPECT_THAT(Refusal(std::string(5000, ' ')), HasSubstr("longer than 4 kB"));
}

}  // namespace
}  // namespace evit::monitor
