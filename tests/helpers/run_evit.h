#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "tests/helpers/paths.h"

namespace evit::test {

/// What a program said on both streams, and how it ended.
struct ProgramOutcome {
  int code = -1;  // -1: not of itself
  std::string output;
};

/// `evit ARGUMENTS`, as a shell reads them.
inline ProgramOutcome RunEvit(const std::string& arguments) {
  std::FILE* pipe = ::popen((ProgramPath("evit") + " " + arguments + " 2>&1").c_str(), "r");
  ProgramOutcome outcome;
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.output.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

}  // namespace evit::test
