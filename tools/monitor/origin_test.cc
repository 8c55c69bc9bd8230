#include "tools/monitor/origin.h"

#include <gtest/gtest.h>

namespace evit::monitor {
namespace {

TEST(OriginPolicy, TheMonitorsOwnPageMayConnect) {
  const OriginPolicy policy("127.0.0.1", {});
  EXPECT_TRUE(policy.Allows("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(policy.Allows("http://localhost:8080", "localhost:8080"));
}

TEST(OriginPolicy, PagesFromElsewhereMayNot) {
  const OriginPolicy policy("127.0.0.1", {});
  EXPECT_FALSE(policy.Allows("http://evil.example", "127.0.0.1:8080"));
  EXPECT_FALSE(policy.Allows("https://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_FALSE(policy.Allows("http://127.0.0.1:9999", "127.0.0.1:8080"));
  EXPECT_FALSE(policy.Allows("http://localhost:8080", "127.0.0.1:8080"));
  EXPECT_FALSE(policy.Allows("null", "127.0.0.1:8080"));
}

TEST(OriginPolicy, ANameThatPointsHereIsNotThisHost) {
  const OriginPolicy policy("127.0.0.1", {});
  EXPECT_FALSE(policy.Allows("http://evil.example:8080", "evil.example:8080"));
  EXPECT_FALSE(policy.AllowsHost("192.168.0.7:8080"));
  EXPECT_FALSE(policy.AllowsHost(""));
  const OriginPolicy everywhere("0.0.0.0", {});
  EXPECT_TRUE(everywhere.AllowsHost("192.168.0.7:8080"));
  EXPECT_FALSE(everywhere.AllowsHost("evil.example:8080"));
}

TEST(OriginPolicy, ProgramsThatAreNoBrowserHaveNoOrigin) {
  EXPECT_TRUE(OriginPolicy("127.0.0.1", {}).Allows("", "127.0.0.1:8080"));
}

TEST(OriginPolicy, FurtherOriginsCanBeAllowed) {
  const OriginPolicy policy("127.0.0.1", {"https://app.foxglove.dev"});
  EXPECT_TRUE(policy.Allows("https://app.foxglove.dev", "localhost:8080"));
  EXPECT_FALSE(policy.Allows("https://app.foxglove.dev.evil.example", "localhost:8080"));
}

}  // namespace
}  // namespace evit::monitor
