#include "common/service/help_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace evit {
namespace {

std::size_t LongestLine(const std::string& text) {
  std::istringstream lines(text);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

std::string Words(int count) {
  std::string words = "word";
  for (int k = 1; k < count; ++k) words += " word";
  return words;
}

TEST(HelpLayout, ShortLinesStayAsTheyAre) {
  const std::string text = "Usage: evit\n\n  --log TEXT                  a log\n";
  EXPECT_EQ(WrapHelp(text), text);
}

TEST(HelpLayout, ADescriptionContinuesInItsColumn) {
  const std::string margin(30, ' ');
  const std::string beside = WrapHelp("  --log TEXT                  " + Words(40) + "\n");
  EXPECT_LE(LongestLine(beside), kHelpColumns);
  EXPECT_NE(beside.find("\n" + margin + "word"), std::string::npos) << beside;
  const std::string below = WrapHelp(margin + Words(40) + "\n");
  EXPECT_LE(LongestLine(below), kHelpColumns);
  EXPECT_NE(below.find("\n" + margin + "word"), std::string::npos) << below;
}

TEST(HelpLayout, ProseContinuesWhereItBegan) {
  const std::string text = WrapHelp(Words(60) + "\n");
  EXPECT_LE(LongestLine(text), kHelpColumns);
  EXPECT_NE(text.find("\nword"), std::string::npos) << text;
}

TEST(HelpLayout, ACommandIsBrokenSoThatItCanBePasted) {
  std::string command = "evit map build";
  for (int k = 0; k < 12; ++k) command += " --option \"a value\"";
  for (const char* before : {"Example: ", "         "}) {
    std::string text = WrapHelp(before + command + "\n");
    EXPECT_LE(LongestLine(text), kHelpColumns);
    EXPECT_NE(text.find(" \\\n             --option"), std::string::npos) << text;
    for (std::size_t at; (at = text.find(" \\\n             ")) != std::string::npos;)
      text.replace(at, 16, " ");
    EXPECT_EQ(text, before + command + "\n");
  }
}

TEST(HelpLayout, AWordLongerThanALineStaysWhole) {
  const std::string text = std::string(150, 'a') + "\n";
  EXPECT_EQ(WrapHelp(text), text);
}

}  // namespace
}  // namespace evit
