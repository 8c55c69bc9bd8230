#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "common/evaluation/trajectory_error.h"
#include "common/geometry/degrees.h"
#include "tests/helpers/paths.h"

namespace evit::test {

inline const std::string kLogs = test::SourcePath("logs/");
inline const std::string kEvit = test::ProgramPath("evit");

/// How a program ended.
struct Result {
  int code = -1;
  std::string output;  // stdout and stderr
};

inline Result Shell(const std::string& command) {
  Result result;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) result.output.append(buffer, n);
  const int status = pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

inline std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Real time at a speed that leaves a machine with other work to do, or sanitized services, time to keep up.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kSlower = 5;
inline const std::string kRealTime = "--realtime --speed 0.2";
#else
constexpr int kSlower = 2;
inline const std::string kRealTime = "--realtime --speed 0.5";
#endif

/// What takes a moment on an idle machine may take this long on a busy one.
constexpr auto kPatience = std::chrono::seconds(60);

/// Whether `condition` comes to hold.
template <typename Condition>
bool Eventually(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

/// Runs of the four services on the sample log, in a folder of the test's own.
class WholeSystem : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::path(::testing::TempDir()) / ("evit_" + name + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  int Restarts(const std::string& out) const {
    const std::string report = ReadAll(Path(out + "/report.json")), key = "\"service_restarts\": ";
    const auto at = report.find(key);
    return at == std::string::npos ? -1 : std::stoi(report.substr(at + key.size()));
  }
  // This test's, not those of tests that run beside it: its files lie in a folder of its own.
  bool Lives(const std::string& service) const { return Shell("pgrep " + Pattern(service)).code == 0; }
  std::string Pattern(const std::string& service) const {
    return "-f '^" + service + " .*" + folder_.string() + "/'";
  }
  std::string RunCommand(const std::string& out, const std::string& more = "") const {
    return PlaceCommand(out, "sample_map.pcd") + " --initial-from " + kLogs + "sample_truth.tum " + more;
  }
  // Without a start pose.
  std::string PlaceCommand(const std::string& out, const std::string& map) const {
    for (const char* file : {"sample_map.pcd", "rig.textproto"}) {
      std::filesystem::copy_file(kLogs + file, Path(file), std::filesystem::copy_options::skip_existing);
    }
    // What others find a run by is the test's own too.
    return "XDG_RUNTIME_DIR=" + folder_.string() + " " + kEvit + " run --log " + kLogs +
           "sample.lcmlog --map " + Path(map) + " --rig " + Path("rig.textproto") + " --out " + Path(out);
  }
  static void ExpectGood(const std::string& trajectory, double max_position, double max_degrees) {
    const TrajectoryError error =
        AbsoluteError(ReadTum(kLogs + "sample_truth.tum"), ReadTum(trajectory), Alignment::kNone);
    EXPECT_GT(error.n_pairs, 30);
    EXPECT_GT(error.reached, 0.95);
    EXPECT_LT(error.position_rmse, max_position);
    EXPECT_LT(error.orientation_rmse, max_degrees / kDegreesPerRadian);
    std::printf("ATE %.2f cm, %.2f deg, %d poses\n", 100 * error.position_rmse,
                error.orientation_rmse * kDegreesPerRadian, error.n_pairs);
  }
  std::filesystem::path folder_;
};

}  // namespace evit::test
