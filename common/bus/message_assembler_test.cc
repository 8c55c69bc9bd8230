#include "common/bus/message_assembler.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace evit {
namespace {

std::string Number(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text.push_back(static_cast<char>(value >> (8 * i)));
  return text;
}

std::string Short(const std::string& rest) { return "LC02" + Number(7, 4) + rest; }

struct Fragment {
  unsigned number = 7, size = 6, offset = 0, fragment = 0, n_fragments = 2;
  std::string rest;
};
std::string Bytes(const Fragment& f) {
  return "LC03" + Number(f.number, 4) + Number(f.size, 4) + Number(f.offset, 4) + Number(f.fragment, 2) +
         Number(f.n_fragments, 2) + f.rest;
}
const Fragment kFirst{7, 6, 0, 0, 2, std::string("IMU\0abc", 7)};
const Fragment kSecond{7, 6, 3, 1, 2, "def"};

class MessageAssemblerTest : public ::testing::Test {
 protected:
  // "CHANNEL:DATA" of the message that this datagram completes; "" where it completes none.
  std::string Add(const std::string& datagram, std::uint64_t sender = 1) {
    MessageAssembler::Message message;
    if (!assembler_.Add(sender, reinterpret_cast<const std::uint8_t*>(datagram.data()), datagram.size(),
                        &message))
      return "";
    return std::string(message.channel) + ":" + std::string(message.data, message.data + message.size);
  }
  MessageAssembler assembler_;
};

TEST_F(MessageAssemblerTest, AShortMessageIsWhole) {
  EXPECT_EQ(Add(Short(std::string("IMU\0data", 8))), "IMU:data");
  EXPECT_EQ(Add(Short(std::string("IMU\0", 4))), "IMU:");
}

TEST_F(MessageAssemblerTest, FragmentsComeTogether) {
  EXPECT_EQ(Add(Bytes(kFirst)), "");
  EXPECT_EQ(Add(Bytes(kSecond)), "IMU:abcdef");
}

TEST_F(MessageAssemblerTest, SendersDoNotMix) {
  Fragment other = kSecond;
  other.rest = "xyz";
  EXPECT_EQ(Add(Bytes(kFirst), 1), "");
  EXPECT_EQ(Add(Bytes(kFirst), 2), "");
  EXPECT_EQ(Add(Bytes(other), 2), "IMU:abcxyz");
  EXPECT_EQ(Add(Bytes(kSecond), 1), "IMU:abcdef");
}

TEST_F(MessageAssemblerTest, ALostFragmentLosesItsMessageAlone) {
  Fragment next_first = kFirst, next_second = kSecond;
  next_first.number = next_second.number = 8;
  EXPECT_EQ(Add(Bytes(kFirst)), "");
  EXPECT_EQ(Add(Bytes(next_first)), "");
  EXPECT_EQ(Add(Bytes(kSecond)), "");  // too late, and it drops the message that was under way
  EXPECT_EQ(Add(Bytes(next_first)), "");
  EXPECT_EQ(Add(Bytes(next_second)), "IMU:abcdef");
}

TEST_F(MessageAssemblerTest, AFragmentThatComesTwiceCountsOnce) {
  Fragment first = kFirst, second = kSecond, third{7, 9, 6, 2, 3, "ghi"};
  first.size = second.size = 9;
  first.n_fragments = second.n_fragments = 3;
  EXPECT_EQ(Add(Bytes(first)), "");
  EXPECT_EQ(Add(Bytes(second)), "");
  EXPECT_EQ(Add(Bytes(second)), "");
  EXPECT_EQ(Add(Bytes(third)), "IMU:abcdefghi");
}

TEST_F(MessageAssemblerTest, ForgedLengthsAreRefused) {
  EXPECT_EQ(Add(""), "");
  EXPECT_EQ(Add("LC02"), "");
  EXPECT_EQ(Add("XXXX" + std::string(30, 'x')), "");
  EXPECT_EQ(Add(Short("no end of the name")), "");
  EXPECT_EQ(Add(Short(std::string(64, 'x') + std::string("\0data", 5))), "");
  EXPECT_EQ(Add(Bytes(kFirst).substr(0, 19)), "");
  Fragment beyond = kFirst;
  beyond.size = 2;  // more data than the message is long
  EXPECT_EQ(Add(Bytes(beyond)), "");
  beyond = kFirst;
  beyond.offset = 0xFFFFFFFF;
  EXPECT_EQ(Add(Bytes(beyond)), "");
  Fragment huge = kFirst;
  huge.size = 0xFFFFFFFF;
  EXPECT_EQ(Add(Bytes(huge)), "");
  Fragment none = kFirst;
  none.n_fragments = 0;
  EXPECT_EQ(Add(Bytes(none)), "");
  EXPECT_EQ(Add(Bytes(kSecond)), "");  // nothing is under way
}

TEST_F(MessageAssemblerTest, ManySendersPushTheOldestOut) {
  for (std::uint64_t sender = 0; sender < 33; ++sender) EXPECT_EQ(Add(Bytes(kFirst), sender), "");
  EXPECT_EQ(Add(Bytes(kSecond), 0), "");
  EXPECT_EQ(Add(Bytes(kSecond), 32), "IMU:abcdef");
}

TEST_F(MessageAssemblerTest, MemoryCanBeTakenOver) {
  const std::string first = Bytes(kFirst), second = Bytes(kSecond);
  MessageAssembler::Message message;
  ASSERT_EQ(Add(first), "");
  ASSERT_TRUE(
      assembler_.Add(1, reinterpret_cast<const std::uint8_t*>(second.data()), second.size(), &message));
  EXPECT_TRUE(message.fragmented);
  std::vector<std::uint8_t> memory;
  assembler_.ExchangeMemory(&memory);
  EXPECT_EQ(Add(first), "");
  EXPECT_EQ(std::string(memory.begin(), memory.begin() + 6), "abcdef");
  EXPECT_EQ(Add(second), "IMU:abcdef");
}

}  // namespace
}  // namespace evit
