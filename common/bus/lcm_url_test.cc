#include "common/bus/lcm_url.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace evit {
namespace {

using ::testing::HasSubstr;

TEST(LcmUrl, NamesGroupHostPortAndReceiveBuffer) {
  const LcmUrl url = ParseLcmUrl("udpm://239.1.2.3:7000?ttl=0&recv_buf_size=100000");
  EXPECT_TRUE(url.multicast);
  EXPECT_EQ(url.group, "239.1.2.3");
  EXPECT_EQ(url.port, 7000);
  EXPECT_EQ(url.receive_buffer, 100000);
  const LcmUrl standard = ParseLcmUrl("udpm://");
  EXPECT_EQ(standard.group, "239.255.76.67");
  EXPECT_EQ(standard.port, 7667);
  EXPECT_EQ(standard.receive_buffer, 0);
  EXPECT_FALSE(ParseLcmUrl("memq://").multicast);
  EXPECT_TRUE(ParseLcmUrl("tcpq://").server);
  EXPECT_EQ(ParseLcmUrl("tcpq://").port, 7700);
  EXPECT_EQ(ParseLcmUrl("tcpq://robot").host, "robot");
  EXPECT_EQ(ParseLcmUrl("tcpq://robot:7701").port, 7701);
  EXPECT_THROW(ParseLcmUrl("tcpq://robot:x"), std::runtime_error);
}

TEST(LcmUrl, RefusesWhatIsMalformed) {
  for (const char* url :
       {"udpm://192.168.0.1:7667", "udpm://host:7667", "udpm://239.1.2.3:0", "udpm://239.1.2.3:x",
        "udpm://239.1.2.3:70000", "udpm://?recv_buf_size=4M", "udpm://?recv_buf_size=-1"}) {
    EXPECT_THROW(ParseLcmUrl(url), std::runtime_error) << url;
  }
}

TEST(LcmUrl, NamesTheOptionThatIsWrong) {
  const auto complaint = [](const std::string& url) -> std::string {
    try {
      ParseLcmUrl(url);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint("udpm://239.1.2.3:7000?ttl=abc"), HasSubstr("ttl \"abc\""));
  EXPECT_THAT(complaint("udpm://?recv_buf_size=9&ttl=256"), HasSubstr("ttl \"256\""));
  EXPECT_THAT(complaint("udpm://?ttl"), HasSubstr("ttl \"\""));
  EXPECT_THAT(complaint("udpm://?tll=1"), HasSubstr("\"tll\""));
  EXPECT_THAT(complaint("udpm://?ttl=0?recv_buf_size=9"), HasSubstr("ttl"));
  EXPECT_EQ(complaint("udpm://?ttl=255&recv_buf_size=9&"), "");
  EXPECT_EQ(complaint("udpm://?transmit_only=false"), "");  // obsolete, and taken by liblcm
}

TEST(LcmUrl, SetsTheReceiveBuffer) {
  EXPECT_EQ(WithReceiveBuffer("udpm://", 5), "udpm://?recv_buf_size=5");
  EXPECT_EQ(WithReceiveBuffer("udpm://239.1.2.3:1?ttl=1", 5), "udpm://239.1.2.3:1?ttl=1&recv_buf_size=5");
  EXPECT_EQ(WithReceiveBuffer("udpm://?recv_buf_size=99", 5), "udpm://?recv_buf_size=5");
  EXPECT_EQ(WithReceiveBuffer("udpm://?recv_buf_size=99&ttl=0", 5), "udpm://?recv_buf_size=5&ttl=0");
}

TEST(LcmUrl, ProbesTheReceiveBuffer) {
  const int granted = ProbeReceiveBuffer(65536);
  EXPECT_EQ(granted, 65536);  // far below any limit
  EXPECT_LE(ProbeReceiveBuffer(1 << 30), 1 << 30);
}

}  // namespace
}  // namespace evit
