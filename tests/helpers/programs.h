#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

namespace evit {

template <typename Condition>
bool Within(std::chrono::milliseconds longest, Condition condition) {
  const auto end = std::chrono::steady_clock::now() + longest;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

// Gone, or ended and not yet reaped by whoever adopted it.
inline bool Gone(pid_t pid) {
  if (kill(pid, 0) != 0) return true;
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string id, name, state;
  file >> id >> name >> state;
  return state == "Z" || state.empty();
}

/// Says hello, and bye when asked to stop.
constexpr char kWaits[] = "trap 'echo bye; exit 0' INT; echo \"here $*\"; while :; do sleep 0.02; done";

/// Programs are shell scripts in a folder of the test's own.
class ProgramsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("programs_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void Program(const std::string& name, const std::string& body) const {
    std::ofstream(folder_ / name) << "#!/bin/sh\n" << body << '\n';
    chmod((folder_ / name).c_str(), 0700);
  }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string Text(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  std::filesystem::path folder_;
};

}  // namespace evit
