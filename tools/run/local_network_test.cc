#include "tools/run/local_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/bus/lcm_bus.h"
#include "common/bus/lcm_url.h"

namespace evit::run {
namespace {

constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=0";

// In a process of its own: a namespace cannot be left again. Its exit code.
template <typename Body>
int InChild(Body body) {
  const pid_t child = fork();
  if (child == 0) {
    int code = 99;
    try {
      code = body();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The thread sanitizer's own thread keeps a process from making a user namespace.
#ifdef __SANITIZE_THREAD__
#define SKIP_WITH_THREADS() GTEST_SKIP() << "the thread sanitizer forbids it"
#else
#define SKIP_WITH_THREADS() static_cast<void>(0)
#endif

std::string Namespace() { return std::filesystem::read_symlink("/proc/self/ns/net").string(); }

TEST(LocalNetwork, MulticastWorksAfterwardsAndStaysOnTheHost) {
  SKIP_WITH_THREADS();
  EXPECT_EQ(InChild([] {
              const std::string before = Namespace();
              const bool made = EnsureLocalMulticast(kUrl);
              if (made == (Namespace() == before)) return 1;
              if (EnsureLocalMulticast(kUrl)) return 2;  // what is there is used
              RequireMulticastRoute(ParseLcmUrl(kUrl));
              const auto sender = OpenLcmBus(kUrl), receiver = OpenLcmBus(kUrl);
              int received = 0;
              receiver->Subscribe("LOCAL_NETWORK_TEST",
                                  [&](const std::string&, const std::uint8_t*, std::size_t) { ++received; });
              for (int k = 0; k < 50 && received == 0; ++k) {
                sender->Publish("LOCAL_NETWORK_TEST", "x", 1);
                receiver->Poll(100);
              }
              return received > 0 ? 0 : 3;
            }),
            0);
}

TEST(LocalNetwork, OthersCanJoinIt) {
  SKIP_WITH_THREADS();
  int ready[2], end[2];
  ASSERT_EQ(pipe(ready), 0);
  ASSERT_EQ(pipe(end), 0);
  const pid_t owner = fork();
  if (owner == 0) {
    EnsureLocalMulticast(kUrl);
    char c = 'x';
    if (write(ready[1], &c, 1) != 1) _exit(1);
    close(end[1]);
    _exit(read(end[0], &c, 1) == 0 ? 0 : 1);  // lives until the test closes its end
  }
  char c = 0;
  ASSERT_EQ(read(ready[0], &c, 1), 1);
  EXPECT_EQ(InChild([&] {
              JoinNetworkOf({owner, ""});
              std::error_code error;
              const auto theirs =
                  std::filesystem::read_symlink("/proc/" + std::to_string(owner) + "/ns/net", error);
              return Namespace() == theirs.string() ? 0 : 1;
            }),
            0);
  const std::string mine = Namespace();
  EXPECT_TRUE(CanJoinNetworkOf({owner, ""}));
  EXPECT_EQ(Namespace(), mine);
  close(end[1]);
  waitpid(owner, nullptr, 0);
  EXPECT_THROW(JoinNetworkOf({owner, ""}), std::runtime_error);
  EXPECT_FALSE(CanJoinNetworkOf({owner, ""}));
}

TEST(LocalNetwork, ChildrenInheritIt) {
  SKIP_WITH_THREADS();
  EXPECT_EQ(InChild([] {
              EnsureLocalMulticast(kUrl);
              const std::string mine = Namespace();
              return InChild([&] { return Namespace() == mine ? 0 : 1; });
            }),
            0);
}

TEST(LocalNetwork, OtherKindsOfBusAreLeftAlone) {
  EXPECT_FALSE(EnsureLocalMulticast("memq://"));
  EXPECT_FALSE(EnsureLocalMulticast("tcpq://127.0.0.1:7700"));
}

TEST(LocalNetwork, RunFileNamesThisProcessWhileItLives) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "run_file_test";
  std::filesystem::create_directories(folder);
  setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
  const std::filesystem::path file = folder / "evit" / ("run-" + std::to_string(getpid()));
  const pid_t dead = fork();
  if (dead == 0) _exit(0);
  waitpid(dead, nullptr, 0);
  const std::filesystem::path left = folder / "evit" / ("run-" + std::to_string(dead));
  std::filesystem::create_directories(left.parent_path());
  std::ofstream(left) << dead;
  {
    const RunFile run_file("some/logs");
    EXPECT_FALSE(std::filesystem::exists(left));
    std::ifstream in(file);
    int pid = 0;
    in >> pid;
    EXPECT_EQ(pid, getpid());
    const auto running = FindRunning();
    ASSERT_TRUE(running.has_value());
    EXPECT_EQ(running->pid, getpid());
    EXPECT_EQ(running->logs, std::filesystem::absolute("some/logs"));
    EXPECT_EQ(ChooseRunning(0).pid, getpid());
    // Of two pipelines the user says which.
    const std::filesystem::path second = folder / "evit" / ("run-" + std::to_string(getppid()));
    std::ofstream(second) << getppid() << "\nother/logs\n";
    EXPECT_EQ(FindAllRunning().size(), 2U);
    EXPECT_THAT([] { ChooseRunning(0); },
                ::testing::ThrowsMessage<std::runtime_error>(
                    ::testing::AllOf(::testing::HasSubstr("--pid"), ::testing::HasSubstr("other/logs"),
                                     ::testing::HasSubstr(std::to_string(getpid())))));
    EXPECT_EQ(ChooseRunning(getppid()).logs, "other/logs");
    EXPECT_THROW(ChooseRunning(1 << 30), std::runtime_error);
    std::filesystem::remove(second);
  }
  EXPECT_FALSE(FindRunning());
  EXPECT_THROW(ChooseRunning(0), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(file));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace evit::run
