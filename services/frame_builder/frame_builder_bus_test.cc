// The real program over real UDP multicast, in a network namespace of the test's own.
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "common/bus/lcm_bus.h"
#include "tests/helpers/frame_builder_peers.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

using Clock = std::chrono::steady_clock;
constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";
const std::string kRig = test::SourcePath("config/vector/rig.textproto");
const std::string kConfig = test::SourcePath("config/tracker.textproto");

/// The program, killed with this.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), test::ProgramPath("frame_builder"));
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, argv[0], nullptr, nullptr, argv.data(), environ), 0);
  }
  ~Program() {
    if (pid_ > 0) ::kill(pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
  }
  void Signal(int signal) const { ::kill(pid_, signal); }
  bool alive() {
    int status = 0;
    return ::waitpid(pid_, &status, WNOHANG) == 0;
  }
  /// Exit code; -1 where it does not end within 10 s, -2 where a signal ended it.
  int Wait() {
    const auto end = Clock::now() + std::chrono::seconds(60);
    for (int status = 0; Clock::now() < end; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
      if (::waitpid(pid_, &status, WNOHANG) != pid_) continue;
      pid_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
    }
    return -1;
  }

 private:
  pid_t pid_ = -1;
};

class FrameBuilderBusTest : public ::testing::Test {
 protected:
  template <typename Condition>
  bool PollUntil(const Condition& holds) {
    const auto end = Clock::now() + std::chrono::seconds(60);
    while (!holds()) {
      if (Clock::now() > end) return false;
      bus_->Poll(5);
    }
    return true;
  }

  std::unique_ptr<Bus> bus_ = OpenLcmBus(kUrl);
  test::Tracker tracker_{bus_.get()};
};

TEST_F(FrameBuilderBusTest, LosslessRunAmidBadInputThenEndsOnSigterm) {
  Program program({"--rig", kRig, "--config", kConfig, "--lossless", "--lcm-url", kUrl});
  test::Sender sender(bus_.get(), test::MakeRecording(500, 2'000'000), 7);
  ASSERT_TRUE(PollUntil([&] { return sender.credit.consumer == "frame_builder"; }));  // here it is
  EXPECT_EQ(sender.credit.stream_epoch, -1);

  std::mt19937 random(1);
  std::vector<std::uint8_t> rubbish(300);
  bool more = true;
  auto went_back = Clock::now();
  ASSERT_TRUE(PollUntil([&] {
    for (std::uint8_t& b : rubbish) b = static_cast<std::uint8_t>(random());
    bus_->Publish(Channels().events, rubbish.data(), random() % rubbish.size());
    bus_->Publish(Channels().imu, rubbish.data(), random() % rubbish.size());
    bus_->Publish(Channels().tracker_mode, rubbish.data(), random() % rubbish.size());
    if (more) more = sender.SendSome(5);
    if (!more) sender.SendEnd();
    // Should the kernel have lost a datagram: once more from there.
    if (!more && Clock::now() - went_back > std::chrono::seconds(1)) {
      sender.GoBack();
      went_back = Clock::now();
      more = true;
    }
    return tracker_.state == "drained";
  }));
  ASSERT_GE(tracker_.keyframes.size(), 20u);
  EXPECT_EQ(tracker_.counters["last_keyframe_seq"], tracker_.keyframes.back().seq);
  EXPECT_GT(tracker_.counters["EVENTS.invalid"], 0);
  EXPECT_GT(tracker_.counters["IMU.invalid"], 0);
  EXPECT_EQ(tracker_.counters["EVENTS.received"], 240);
  EXPECT_EQ(tracker_.keyframes[0].width, 640);
  EXPECT_EQ(tracker_.keyframes[0].surface_size, 640 * 480);
  int later = 0;
  for (std::size_t i = 1; i < tracker_.keyframes.size(); ++i) {
    EXPECT_EQ(tracker_.keyframes[i].previous_utime, tracker_.keyframes[i - 1].utime);
    later += tracker_.keyframes[i].high_rate == 0;
  }
  EXPECT_GT(later, 10);

  ASSERT_TRUE(program.alive());
  program.Signal(SIGTERM);
  EXPECT_EQ(program.Wait(), 0);
  EXPECT_TRUE(PollUntil([&] { return tracker_.state == "finished"; }));
}

TEST_F(FrameBuilderBusTest, RealTimeMakesKeyframesWithoutAnyAnswer) {
  Program program({"--rig", kRig, "--config", kConfig, "--lcm-url", kUrl, "--prefix", ""});
  tracker_.answer_at_once = false;
  ASSERT_TRUE(PollUntil([&] { return tracker_.state == "waiting"; }));
  test::Sender sender(bus_.get(), test::MakeRecording(500), 7);
  ASSERT_TRUE(PollUntil([&] {
    if (sender.SendSome(2)) return false;
    sender.SendEnd();
    return tracker_.state == "drained";
  }));
  EXPECT_GT(tracker_.keyframes.size(), 90u);  // every 10 ms: nobody says that bootstrapping is over
  program.Signal(SIGINT);
  EXPECT_EQ(program.Wait(), 0);
}

TEST_F(FrameBuilderBusTest, RefusesFilesItCannotUse) {
  EXPECT_EQ(Program({"--rig", "/nowhere/rig.textproto", "--config", kConfig, "--lcm-url", kUrl}).Wait(), 1);
  const std::string broken = ::testing::TempDir() + "frame_builder_bus_test.textproto";
  std::ofstream(broken) << "keyframes { n_evnt: 1 }\n";
  EXPECT_EQ(Program({"--rig", kRig, "--config", broken, "--lcm-url", kUrl}).Wait(), 1);
  std::remove(broken.c_str());
  EXPECT_NE(Program({"--config", kConfig}).Wait(), 0);
}

}  // namespace
}  // namespace evit
