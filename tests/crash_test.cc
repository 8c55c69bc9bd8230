// Services, and the server of messages, that die while a run is at work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "tests/helpers/tcpq_server.h"
#include "tests/helpers/whole_system.h"

namespace evit {
namespace {

namespace fs = std::filesystem;
using test::Eventually;
using test::kLogs;
using test::kRealTime;
using test::kSlower;
using test::ReadAll;
using test::Result;
using test::Shell;
using ::testing::HasSubstr;

class CrashTest : public test::WholeSystem {
 protected:
  // Runs, and kills a service so many times, each time this long after it has been there.
  Result RunAndKill(const std::string& command, const std::string& service, int times,
                    std::chrono::milliseconds life) const {
    std::atomic<bool> over{false};
    std::thread killer([&] {
      for (int k = 0; k < times; ++k) {
        Eventually([&] { return over || Lives(service); });
        std::this_thread::sleep_for(life);
        Kill(service);
      }
    });
    Result result = Shell(command);
    over = true;
    killer.join();
    return result;
  }
  // Kills a service twice in a run of 3 s of sensor time.
  void KillInRealTime(const std::string& service) {
    const Result result =
        RunAndKill(RunCommand("out", kRealTime), service, 2, kSlower * std::chrono::milliseconds(1000));
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
  void Kill(const std::string& service) const { Shell("pkill -9 " + Pattern(service)); }
};

TEST_F(CrashTest, SurvivesMapServerCrashes) {
  // Killed repeatedly during the run: it is restarted each time, and the result is the same.
  const Result result = RunAndKill(RunCommand("killed"), "map_server", 3, std::chrono::milliseconds(100));
  ASSERT_EQ(result.code, 0) << result.output;
  EXPECT_GE(Restarts("killed"), 1) << result.output;
  ExpectGood(Path("killed/trajectory.tum"), 0.015, 0.6);
}

// Nobody says where it begins, and map_server dies while it searches.
TEST_F(CrashTest, FindsItsPlaceWithoutAStartPose) {
  const Result result =
      RunAndKill(PlaceCommand("found", "sample_map.pcd"), "map_server", 1, std::chrono::milliseconds(400));
  ASSERT_EQ(result.code, 0) << result.output;
  EXPECT_GE(Restarts("found"), 1) << result.output;
  const Trajectory truth = ReadTum(kLogs + "sample_truth.tum");
  const Trajectory online = ReadTum(Path("found/trajectory.tum"));
  ASSERT_FALSE(online.empty());
  EXPECT_LT(online.front().t, truth.front().t + 2'000'000);
  for (const StampedPose& pose : online) {
    SE3 there;
    if (!PoseAt(truth, pose.t, &there)) continue;
    EXPECT_LT((pose.pose.p - there.p).norm(), 0.1) << pose.t;
    EXPECT_LT(AngularDistance(pose.pose.q, there.q), 0.05) << pose.t;
  }
}

// The server that all messages go through dies while a run is at work.
TEST_F(CrashTest, ATcpqServerThatGoesAwayEndsTheRunWithItsName) {
  test::TcpqServer server;
  ASSERT_NE(server.port(), 0);
  const std::string url = "tcpq://127.0.0.1:" + std::to_string(server.port());
  Result run;
  std::thread running([&] { run = Shell(RunCommand("out", "--realtime --speed 0.25 --lcm-url " + url)); });
  // Keyframes and poses by the hundred: it is at work.
  EXPECT_TRUE(Eventually([&] { return server.n_messages() > 500; })) << server.n_messages();
  server.Stop();
  running.join();
  EXPECT_EQ(run.code, 1) << run.output;
  EXPECT_THAT(run.output, HasSubstr("tcpq: the server at " + url.substr(7) + " is gone"));
  for (const char* service : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
    EXPECT_FALSE(Lives(service)) << service;
    const std::string log = ReadAll(Path(std::string("out/") + service + ".log"));
    EXPECT_EQ(log.find("terminate called"), std::string::npos) << log;
  }
}

TEST_F(CrashTest, SurvivesLogReplayCrashInRealTime) { KillInRealTime("log_replay"); }

TEST_F(CrashTest, SurvivesFrameBuilderCrashInRealTime) { KillInRealTime("frame_builder"); }

TEST_F(CrashTest, SurvivesOptimizerCrashInRealTime) { KillInRealTime("window_optimizer"); }

}  // namespace
}  // namespace evit
