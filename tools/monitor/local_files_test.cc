#include "tools/monitor/local_files.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

namespace evit::monitor {
namespace {

TEST(LocalFiles, OptionsAreReadInBothForms) {
  EXPECT_EQ(OptionValue({"map_server", "--map", "a b.pcd"}, "--map"), "a b.pcd");
  EXPECT_EQ(OptionValue({"map_server", "--map=x=y.pcd"}, "--map"), "x=y.pcd");
  EXPECT_EQ(OptionValue({"map_server", "--map"}, "--map"), "");
  EXPECT_EQ(OptionValue({"frame_builder", "--mapping", "x"}, "--map"), "");
}

TEST(LocalFiles, AreThoseOfTheServicesOnABus) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / ("evit_bus_files_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "rig.textproto") << "x";
  const std::string url = "memq://" + std::to_string(getpid());  // told by the environment, as evit up does
  const pid_t child = fork();
  if (child == 0) {
    setenv("LCM_DEFAULT_URL", url.c_str(), 1);
    if (chdir(folder.c_str()) == 0) {
      execl("/bin/sh", "window_optimizer", "-c", "sleep 20; :", "--rig", "rig.textproto", "--initial-pose",
            "1 2 3 0 0 0 1", "--prefix", "a/", nullptr);
    }
    _exit(1);
  }
  LocalFiles files;
  for (int i = 0; i < 500 && files.rig.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    files = FindLocalFiles(url, "a/");
  }
  EXPECT_EQ(FindLocalFiles(url, "").rig, "");
  EXPECT_EQ(FindLocalFiles(url + "0", "a/").rig, "");
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(files.rig, (std::filesystem::canonical(folder) / "rig.textproto").string());
  EXPECT_EQ(files.start, "1 2 3 0 0 0 1");
  EXPECT_FALSE(files.complete());  // no map
  std::filesystem::remove_all(folder);
}

TEST(LocalFiles, AreThoseOfTheSupervisorsChildren) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / ("evit_local_files_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "map.pcd") << "x";
  const pid_t child = fork();
  if (child == 0) {
    // A relative name counts from where the child was started; "rig" does not exist.
    if (chdir(folder.c_str()) == 0) {
      execl("/bin/sh", "sh", "-c", "sleep 20; :", "--map", "map.pcd", "--rig", "rig.textproto", nullptr);
    }
    _exit(1);
  }
  LocalFiles files;
  for (int i = 0; i < 500 && files.map.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    files = FindLocalFiles(getpid());
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(files.map, (std::filesystem::canonical(folder) / "map.pcd").string());
  EXPECT_EQ(files.rig, "");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace evit::monitor
