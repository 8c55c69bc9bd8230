#include "common/bus/channel_filter.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>

namespace evit {
namespace {

using ::testing::ElementsAre;

// A receiving socket of the loopback, and one that sends to it.
class ChannelFilterTest : public ::testing::Test {
 protected:
  ChannelFilterTest() {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(to_, Address(), sizeof address_), 0);
    socklen_t size = sizeof address_;
    EXPECT_EQ(::getsockname(to_, Address(), &size), 0);
  }
  ~ChannelFilterTest() override { ::close(from_), ::close(to_); }

  sockaddr* Address() { return reinterpret_cast<sockaddr*>(&address_); }
  void Send(const std::string& datagram) {
    EXPECT_EQ(::sendto(from_, datagram.data(), datagram.size(), 0, Address(), sizeof address_),
              static_cast<ssize_t>(datagram.size()));
  }
  // As LCM sends them: magic, number, and of a fragment size, offset, its number, how many.
  void SendShort(const std::string& channel, const std::string& data) {
    Send("LC02" + std::string(4, '\1') + channel + '\0' + data);
  }
  void SendFragment(char number, const std::string& text) {
    Send("LC03" + std::string(4, '\1') + std::string(8, '\0') + '\0' + number + '\0' + '\2' + text);
  }
  // What has arrived, by its last three bytes.
  std::vector<std::string> Heard() {
    std::vector<std::string> heard;
    char buffer[512];
    for (ssize_t n = 0; (n = ::recv(to_, buffer, sizeof buffer, MSG_DONTWAIT)) >= 3;)
      heard.emplace_back(buffer + n - 3, 3);
    return heard;
  }

  int from_ = ::socket(AF_INET, SOCK_DGRAM, 0), to_ = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address_{};
};

TEST_F(ChannelFilterTest, PassesTheseChannelsAlone) {
  if (!HearOnlyChannels(to_, {"EVENTS", "IMU", "a/KEYFRAME"})) GTEST_SKIP() << "not on this kernel";
  SendShort("EVENTS", "one");
  SendShort("EVENTSX", "no1");
  SendShort("EVENT", "no2");
  SendShort("IMU", "two");
  SendShort("KEYFRAME", "no3");
  SendShort("a/KEYFRAME", "tri");
  SendShort("", "no4");
  SendFragment(0, std::string("IMU") + '\0' + "fou");
  SendFragment(0, std::string("OTHER") + '\0' + "no5");
  SendFragment(1, "fiv");  // no channel in it
  Send("no message of LCM's: six");
  EXPECT_THAT(Heard(), ElementsAre("one", "two", "tri", "fou", "fiv", "six"));
}

TEST_F(ChannelFilterTest, CalledAgainReplacesTheChannels) {
  if (!HearOnlyChannels(to_, {"A"})) GTEST_SKIP() << "not on this kernel";
  ASSERT_TRUE(HearOnlyChannels(to_, {"A", "B"}));
  SendShort("A", "one");
  SendShort("B", "two");
  SendShort("C", "no1");
  EXPECT_THAT(Heard(), ElementsAre("one", "two"));
}

TEST_F(ChannelFilterTest, WhereTheKernelRefusesEverythingPasses) {
  if (!HearOnlyChannels(to_, {"A"})) GTEST_SKIP() << "not on this kernel";
  EXPECT_FALSE(HearOnlyChannels(to_, std::vector<std::string>(2000, "A_LONG_NAME")));
  SendShort("B", "one");
  EXPECT_THAT(Heard(), ElementsAre("one"));
}

TEST_F(ChannelFilterTest, FindsTheSocketsOfAPort) {
  EXPECT_THAT(SocketsOnPort(ntohs(address_.sin_port)), ElementsAre(to_));
}

}  // namespace
}  // namespace evit
