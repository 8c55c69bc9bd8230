// Replay and frame building on one host, map and optimiser on another: two network namespaces joined by a
// cable (veth), UDP multicast between them. Runs in a namespace of its own, which is the first host.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "common/bus/lcm_bus.h"
#include "common/evaluation/trajectory_error.h"
#include "tests/helpers/child_process.h"
#include "tests/helpers/paths.h"
#include "tools/run/recorder.h"

namespace evit {
namespace {

using std::chrono::seconds;
namespace fs = std::filesystem;

const std::string kLogs = test::SourcePath("logs/");
constexpr char kUrl[] =
    "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4194304";  // one hop: to the other host

class TwoHostsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    other_host_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{"/usr/bin/unshare", "-n", "sleep", "300"}, Path("host"));
    pid_ = std::to_string(other_host_->pid());
    const fs::path ours = fs::read_symlink("/proc/self/ns/net");
    const auto give_up = std::chrono::steady_clock::now() + seconds(60);
    std::error_code error;
    while (fs::read_symlink("/proc/" + pid_ + "/ns/net", error) == ours || error) {
      ASSERT_LT(std::chrono::steady_clock::now(), give_up) << "no second network namespace";
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    Shell("ip link add cable_a type veth peer name cable_b netns " + pid_);
    Shell("ip addr add 10.77.0.1/24 dev cable_a && ip link set cable_a up");
    Shell("ip route replace 224.0.0.0/4 dev cable_a");
    OnOther("ip link set lo up && ip addr add 10.77.0.2/24 dev cable_b && ip link set cable_b up");
    OnOther("ip route add 224.0.0.0/4 dev cable_b");
  }

  static std::string Path(const std::string& name) {
    return ::testing::TempDir() + "evit_two_hosts_" + name + "_" + std::to_string(::getpid());
  }
  static void Shell(const std::string& command) { ASSERT_EQ(std::system(command.c_str()), 0) << command; }
  void OnOther(const std::string& command) const {
    Shell("nsenter -t " + pid_ + " -n sh -c '" + command + "'");
  }

  // A service on this host, or on the other one.
  std::unique_ptr<ChildProcess> Start(bool here, const std::string& name,
                                      std::vector<std::string> arguments) const {
    std::vector<std::string> command{test::ProgramPath(name)};
    if (!here) command.insert(command.begin(), {"/usr/bin/nsenter", "-t", pid_, "-n"});
    command.insert(command.end(), arguments.begin(), arguments.end());
    command.insert(command.end(), {"--lcm-url", kUrl});
    return std::make_unique<ChildProcess>(command, Path(name));
  }

  std::unique_ptr<ChildProcess> other_host_;
  std::string pid_;
};

TEST_F(TwoHostsTest, TracksAcrossTheCable) {
  const std::string rig = kLogs + "rig.textproto", config = test::SourcePath("config/tracker.textproto");
  const Trajectory truth = ReadTum(kLogs + "sample_truth.tum");
  const std::string line = TumLine(truth.front());
  const auto bus = OpenLcmBus(kUrl);
  run::Recorder recorder(bus.get(), Channels());
  const auto map_server = Start(false, "map_server", {"--map", kLogs + "sample_map.pcd"});
  const auto optimizer = Start(
      false, "window_optimizer",
      {"--rig", rig, "--config", config, "--lossless", "--initial-pose", line.substr(line.find(' ') + 1)});
  const auto builder = Start(true, "frame_builder", {"--rig", rig, "--config", config, "--lossless"});
  const auto replay = Start(true, "log_replay", {"--log", kLogs + "sample.lcmlog", "--lossless"});
  const auto give_up = std::chrono::steady_clock::now() + seconds(180);
  while (!recorder.Finished() && std::chrono::steady_clock::now() < give_up) bus->Poll(20);
  ASSERT_TRUE(recorder.Finished()) << optimizer->Stderr() << builder->Stderr() << map_server->Stderr();
  const TrajectoryError error = AbsoluteError(truth, recorder.online(), Alignment::kNone);
  EXPECT_GT(error.reached, 0.95);
  EXPECT_LT(error.position_rmse, 0.015);
  // The cable was used: the optimiser's host saw keyframes that only this one sends.
  EXPECT_GT(recorder.online().size(), 30u);
  for (const auto& [name, status] : recorder.statuses()) {
    EXPECT_EQ(run::CounterOf(status, "KEYFRAME.lost"), 0) << name;
    EXPECT_EQ(run::CounterOf(status, "bus.send_errors"), 0) << name;
  }
}

}  // namespace
}  // namespace evit
