// The help of each program and command, as it is called.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "common/service/help_layout.h"
#include "tests/helpers/run_evit.h"

namespace evit {
namespace {

std::string HelpOf(const std::string& program) {
  std::FILE* pipe = ::popen((test::ProgramPath(program) + " --help 2>&1").c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    text.append(buffer.data(), n);
  EXPECT_EQ(::pclose(pipe), 0) << program;
  return text;
}

void ExpectNarrow(const std::string& program, const std::string& help) {
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(line.size(), kHelpColumns) << program << ": " << line;
}

// A command and all below it; how many these are.
int ExpectNarrowBelow(const std::string& command) {
  const std::string help = HelpOf(command);
  ExpectNarrow(command, help);
  int n = 1;
  const std::size_t list = help.find("\nSubcommands:\n");
  std::istringstream lines(list == std::string::npos ? "" : help.substr(list + 14));
  static const std::regex kName("  ([a-z]+) .*");
  for (std::string line; std::getline(lines, line) && !line.empty();) {
    std::smatch name;
    if (std::regex_match(line, name, kName))
      n += ExpectNarrowBelow(std::string(command).append(" ").append(name[1].str()));
  }
  return n;
}

TEST(Help, OfEachCommandHasLinesOf100ColumnsAtMost) { EXPECT_GE(ExpectNarrowBelow("evit"), 40); }

TEST(Help, OfEachServiceHasLinesOf100ColumnsAtMost) {
  for (const char* service : {"log_replay", "frame_builder", "map_server", "window_optimizer"})
    ExpectNarrow(service, HelpOf(service));
}

}  // namespace
}  // namespace evit
