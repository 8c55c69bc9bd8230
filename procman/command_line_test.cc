#include "procman/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit::procman {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::ThrowsMessage;

std::optional<std::string> Variable(const std::string& name) {
  if (name == "MAP") return "a map.pcd";
  if (name == "EMPTY") return "";
  return std::nullopt;
}

CommandLine Split(const std::string& line) { return SplitCommandLine(line, &Variable); }

TEST(CommandLineTest, SplitsLikeAShell) {
  EXPECT_THAT(Split("a  b\tc ").words, ElementsAre("a", "b", "c"));
  EXPECT_THAT(Split(R"(a 'b c' "d e" f\ g "h\"i" 'j"k')").words,
              ElementsAre("a", "b c", "d e", "f g", "h\"i", "j\"k"));
  EXPECT_THAT(Split(R"(a '' "" b)").words, ElementsAre("a", "", "", "b"));
  EXPECT_THAT(Split(R"(--x="1 2"3)").words, ElementsAre("--x=1 23"));
}

TEST(CommandLineTest, ExpandsVariables) {
  EXPECT_THAT(Split("m $MAP").words, ElementsAre("m", "a", "map.pcd"));
  EXPECT_THAT(Split("m \"${MAP}x\" '${MAP}' ${EMPTY} \"$EMPTY\"").words,
              ElementsAre("m", "a map.pcdx", "${MAP}", ""));
  EXPECT_THAT([] { Split("m ${NONE}"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("NONE, which is not set")));
}

TEST(CommandLineTest, EnvironmentComesBeforeTheProgram) {
  const CommandLine line = Split("A=1 B='x y' program C=3 -d");
  EXPECT_THAT(line.environment, ElementsAre(Pair("A", "1"), Pair("B", "x y")));
  EXPECT_THAT(line.words, ElementsAre("program", "C=3", "-d"));
  EXPECT_THAT(Split("./a=b c").words, ElementsAre("./a=b", "c"));
}

TEST(CommandLineTest, OpenQuotesAndEmptyLinesAreErrors) {
  for (const char* bad : {"a 'b", "a \"b", "a \\", "a ${B", "a $", "", "  ", "A=1"}) {
    EXPECT_THROW(Split(bad), std::runtime_error) << bad;
  }
}

TEST(CommandLineTest, JoinAndSplitRoundTrip) {
  const std::vector<std::string> words{"a=b", "-x", "", "it's", "a b", "\"q\"", "$HOME", "back\\slash"};
  const CommandLine line = Split(JoinCommandLine(words));
  EXPECT_EQ(line.words, words);
  EXPECT_THAT(line.environment, IsEmpty());
}

}  // namespace
}  // namespace evit::procman
