// The main job: four real processes over real UDP on the sample log. Runs in a network namespace of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "common/evaluation/covariance_file.h"
#include "common/evaluation/trajectory_error.h"

namespace evit {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kLogs = std::string(EVIT_SOURCE_DIR) + "/logs/";
const std::string kEvit = std::string(EVIT_BIN_DIR) + "/evit";

struct Result {
  int code = -1;
  std::string output;  // stdout and stderr
};

Result Shell(const std::string& command) {
  Result result;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) result.output.append(buffer, n);
  const int status = pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// Sanitized services are several times slower than real time allows.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kSlower = 5;
const std::string kRealTime = "--realtime --speed 0.2";
#else
constexpr int kSlower = 1;
const std::string kRealTime = "--realtime";
#endif

class WholeSystemTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = fs::path(::testing::TempDir()) / ("evit_" + name + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  // Kills a service twice in a run of 3 s.
  void KillInRealTime(const std::string& service) {
    const std::string command = RunCommand("out", kRealTime);
    std::thread killer([&] {
      for (int k = 0; k < 2; ++k) {
        std::this_thread::sleep_for(kSlower * std::chrono::milliseconds(1300));
        Kill(service);
      }
    });
    const Result result = Shell(command);
    killer.join();
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_GE(Restarts("out"), 1) << result.output;
    ExpectGood(Path("out/trajectory.tum"), 0.02, 0.8);
    Utime longest = 0;  // without a pose
    const Trajectory online = ReadTum(Path("out/trajectory.tum"));
    for (std::size_t k = 1; k < online.size(); ++k)
      longest = std::max(longest, online[k].t - online[k - 1].t);
    std::printf("longest time without a pose: %.0f ms\n", static_cast<double>(longest) * 1e-3);
    EXPECT_LT(longest, 700'000);
    EXPECT_FALSE(fs::exists(Path("out/checkpoint")));
  }
  int Restarts(const std::string& out) const {
    const std::string report = ReadAll(Path(out + "/report.json")), key = "\"service_restarts\": ";
    const auto at = report.find(key);
    return at == std::string::npos ? -1 : std::stoi(report.substr(at + key.size()));
  }
  // This test's, not those of tests that run beside it: its files lie in a folder of its own.
  void Kill(const std::string& service) const {
    Shell("pkill -9 -f '^" + service + " .*" + folder_.string() + "/'");
  }
  std::string RunCommand(const std::string& out, const std::string& more = "") const {
    for (const char* file : {"sample_map.pcd", "rig.textproto"}) {
      fs::copy_file(kLogs + file, Path(file), fs::copy_options::skip_existing);
    }
    // What others find a run by is the test's own too.
    return "XDG_RUNTIME_DIR=" + folder_.string() + " " + kEvit + " run --log " + kLogs +
           "sample.lcmlog --map " + Path("sample_map.pcd") + " --rig " + Path("rig.textproto") +
           " --initial-from " + kLogs + "sample_truth.tum --out " + Path(out) + " " + more;
  }
  static void ExpectGood(const std::string& trajectory, double max_position, double max_degrees) {
    const TrajectoryError error =
        AbsoluteError(ReadTum(kLogs + "sample_truth.tum"), ReadTum(trajectory), Alignment::kNone);
    EXPECT_GT(error.n_pairs, 30);
    EXPECT_GT(error.coverage, 0.95);
    EXPECT_LT(error.position_rmse, max_position);
    EXPECT_LT(error.orientation_rmse, max_degrees / 57.295779513);
    std::printf("ATE %.2f cm, %.2f deg, %d poses\n", 100 * error.position_rmse,
                error.orientation_rmse * 57.295779513, error.n_pairs);
  }
  fs::path folder_;
};

TEST_F(WholeSystemTest, TracksTheSampleLogBitIdentically) {
  for (const char* out : {"a", "b"}) {
    const Result result = Shell(RunCommand(out));
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("real-time factor"));
  }
  ExpectGood(Path("a/trajectory.tum"), 0.015, 0.6);
  ExpectGood(Path("a/smoothed.tum"), 0.015, 0.6);
  EXPECT_EQ(ReadAll(Path("a/trajectory.tum")), ReadAll(Path("b/trajectory.tum")));
  EXPECT_EQ(ReadAll(Path("a/smoothed.tum")), ReadAll(Path("b/smoothed.tum")));
  EXPECT_EQ(ReadAll(Path("a/covariance.csv")), ReadAll(Path("b/covariance.csv")));
  const Covariances covariances = ReadCovariances(Path("a/covariance.csv"));
  const Trajectory online = ReadTum(Path("a/trajectory.tum"));
  ASSERT_EQ(covariances.size(), online.size());
  for (std::size_t k = 0; k < online.size(); ++k) EXPECT_EQ(covariances[k].t, online[k].t);
  EXPECT_GT(fs::file_size(Path("a/trajectory.png")), 10'000U);
  EXPECT_GT(fs::file_size(Path("a/consistency.png")), 10'000U);
  const std::string report = ReadAll(Path("a/report.json"));
  for (const char* key : {"real_time_factor", "final_mode", "TRACKING", "granted_receive_buffer", "mean_ms",
                          "n_event", "position_rmse_cm", "mode_changes", "orientation_nees"}) {
    EXPECT_THAT(report, HasSubstr(key));
  }
}

TEST_F(WholeSystemTest, TracksInRealTime) {
  const Result result = Shell(RunCommand("live", kRealTime));
  ASSERT_EQ(result.code, 0) << result.output;
  ExpectGood(Path("live/trajectory.tum"), 0.02, 0.8);
}

TEST_F(WholeSystemTest, SurvivesMapServerCrashes) {
  // Killed repeatedly during the run: it is restarted each time, and the result is the same.
  std::thread killer([this] {
    for (int k = 0; k < 3; ++k) {
      std::this_thread::sleep_for(kSlower * std::chrono::milliseconds(250));
      Kill("map_server");
    }
  });
  const Result result = Shell(RunCommand("killed"));
  killer.join();
  ASSERT_EQ(result.code, 0) << result.output;
  EXPECT_GE(Restarts("killed"), 1) << result.output;
  ExpectGood(Path("killed/trajectory.tum"), 0.015, 0.6);
}

TEST_F(WholeSystemTest, RunningPipelineCanBeListedAndCommanded) {
  std::thread run([&] { EXPECT_EQ(Shell(RunCommand("out", kRealTime)).code, 0); });
  std::this_thread::sleep_for(kSlower * std::chrono::milliseconds(700));
  const std::string evit = "XDG_RUNTIME_DIR=" + folder_.string() + " " + kEvit + " ";
  const Result ps = Shell(evit + "ps");
  EXPECT_EQ(ps.code, 0);
  for (const char* service : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
    EXPECT_THAT(ps.output, testing::ContainsRegex(std::string(service) + " +running +[0-9]+"));
  }
  const Result restart = Shell(evit + "restart window_optimizer");
  EXPECT_EQ(restart.code, 0) << restart.output;
  const Result logs = Shell(evit + "logs window_optimizer");
  EXPECT_THAT(logs.output, HasSubstr("tracking"));
  const Result wrong = Shell(evit + "restart windows");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.output, HasSubstr("no command \"windows\"; there are: map_server, window_optimizer"));
  run.join();
  ExpectGood(Path("out/trajectory.tum"), 0.02, 0.8);
  EXPECT_EQ(Restarts("out"), 0);  // ordered restarts are not deaths
  EXPECT_THAT(Shell(evit + "ps").output, HasSubstr("neither `evit run` nor `evit up` is running"));
}

TEST_F(WholeSystemTest, SurvivesLogReplayCrashInRealTime) { KillInRealTime("log_replay"); }

TEST_F(WholeSystemTest, SurvivesFrameBuilderCrashInRealTime) { KillInRealTime("frame_builder"); }

TEST_F(WholeSystemTest, SurvivesOptimizerCrashInRealTime) { KillInRealTime("window_optimizer"); }

TEST_F(WholeSystemTest, LcmToolsCanPlayAndRecord) {
  // The stock player feeds the three other services; the stock logger records their messages.
  const std::string bin = std::string(EVIT_BIN_DIR) + "/",
                    rig = " --rig " + kLogs + "rig.textproto --config " + std::string(EVIT_SOURCE_DIR) +
                          "/config/tracker.textproto";
  const Trajectory truth = ReadTum(kLogs + "sample_truth.tum");
  const std::string line = TumLine(truth.front());
  const std::string url = "'udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304'";
  const std::string script =
      "export LCM_DEFAULT_URL=" + url + "; " + bin + "map_server --map " + kLogs + "sample_map.pcd & M=$!; " +
      bin + "frame_builder" + rig + " & F=$!; " + bin + "window_optimizer" + rig + " --initial-pose '" +
      line.substr(line.find(' ') + 1) + "' & W=$!; sleep 1; lcm-logger -q " + Path("result.lcmlog") +
      " & L=$!; sleep 0.5; lcm-logplayer " + kLogs +
      "sample.lcmlog >/dev/null; sleep 1; kill -TERM $L $M $F $W; wait $M && wait $F && wait $W";
  std::ofstream(Path("play.sh")) << script;
  const Result result = Shell("timeout 60 sh " + Path("play.sh"));
  EXPECT_EQ(result.code, 0) << result.output;
  const Result channels = Shell("strings -n 8 " + Path("result.lcmlog") + " | grep -c WINDOW_STATE");
  EXPECT_GT(std::atoi(channels.output.c_str()), 20) << channels.output;
}

TEST_F(WholeSystemTest, BadInputIsNamedAndLeavesNothingBehind) {
  std::ofstream(Path("empty.pcd"))
      << "# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT "
         "1\nPOINTS 0\nDATA ascii\n";
  {
    std::ofstream millimetres(Path("mm.txt"));
    for (int x = 0; x < 20; ++x) {
      for (int y = 0; y < 20; ++y) millimetres << 1000 + 7 * x << ' ' << 7 * y << " 900\n";
    }
  }
  std::string rig = ReadAll(kLogs + "rig.textproto");
  std::ofstream(Path("no_fx.textproto")) << rig.replace(rig.find("  fx:"), 4, "  # ");
  const auto with = [&](const std::string& option, const std::string& value) {
    std::string command = RunCommand("out");
    const std::size_t begin = command.find("--" + option + " ") + option.size() + 3;
    return command.replace(begin, command.find(' ', begin) - begin, value);
  };
  const struct {
    std::string command, expected;
  } cases[] = {
      {with("log", Path("none.lcmlog")), "none.lcmlog"},
      {with("map", Path("empty.pcd")), "empty"},
      {with("map", Path("mm.txt")), "millimetres"},
      {with("rig", Path("no_fx.textproto")), "fx"},
      {with("initial-from", Path("none.tum")), "none.tum"},
      {with("out", "/proc/nowhere"), "/proc/nowhere"},
      {kEvit + " import vector " + kLogs + " --sequence nothing --out " + Path("x.lcmlog"),
       "sequences found there"},
      {kEvit + " run --log x", "--rig is required"},
  };
  for (const auto& c : cases) {
    const Result result = Shell(c.command);
    EXPECT_NE(result.code, 0) << c.command;
    EXPECT_THAT(result.output, HasSubstr(c.expected)) << c.command;
    EXPECT_FALSE(fs::exists(Path("out"))) << c.command;
    EXPECT_FALSE(fs::exists(Path("x.lcmlog"))) << c.command;
  }
}

}  // namespace
}  // namespace evit
