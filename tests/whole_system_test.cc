// The main job: four real processes over real UDP on the sample log. Runs in a network namespace of its own.
#include "tests/helpers/whole_system.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <thread>
#include <vector>

#include "common/bus/log_file.h"
#include "common/evaluation/covariance_file.h"
#include "common/evaluation/trajectory_error.h"
#include "common/map/map_file.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

namespace fs = std::filesystem;
using test::Eventually;
using test::kEvit;
using test::kLogs;
using test::kRealTime;
using test::ReadAll;
using test::Result;
using test::Shell;
using ::testing::HasSubstr;

class WholeSystemTest : public test::WholeSystem {};

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
  // The poses of the bootstrapping have none and are left out; all that follow have one.
  ASSERT_LE(covariances.size(), online.size());
  ASSERT_GT(covariances.size(), online.size() * 9 / 10);
  const std::size_t without = online.size() - covariances.size();
  for (std::size_t k = 0; k < covariances.size(); ++k) EXPECT_EQ(covariances[k].t, online[without + k].t);
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

// A recording of a camera alone: EVIT refuses it, and says by which settings it can be tracked.
TEST_F(WholeSystemTest, TracksByEventsAloneWhereThereIsNoImu) {
  {
    const LogReader log(kLogs + "sample.lcmlog");
    LogWriter bare(Path("bare.lcmlog"));
    std::vector<std::uint8_t> bytes;
    for (const LogEntry& entry : log.entries()) {
      if (log.channel(entry) == "IMU") continue;
      log.Read(entry, &bytes);
      bare.Write(entry.utime, log.channel(entry), bytes.data(), bytes.size());
    }
    bare.Close();
  }
  const std::string begin = kEvit + " run --log " + Path("bare.lcmlog") + " --map " + kLogs +
                            "sample_map.pcd --rig " + kLogs + "rig.textproto --initial-from " + kLogs +
                            "sample_truth.tum --seconds 0:1.6 --out ";
  Result result = Shell(begin + Path("refused"));
  EXPECT_NE(result.code, 0);
  EXPECT_THAT(result.output, HasSubstr("config/evt.textproto"));
  for (const char* out : {"a", "b"}) {
    result = Shell(begin + Path(out) + " --config " + test::SourcePath("config/evt.textproto"));
    ASSERT_EQ(result.code, 0) << result.output;
  }
  const TrajectoryError error =
      AbsoluteError(ReadTum(kLogs + "sample_truth.tum"), ReadTum(Path("a/trajectory.tum")), Alignment::kNone);
  EXPECT_GT(error.n_pairs, 30);
  EXPECT_LT(error.position_max, 0.03);
  EXPECT_EQ(ReadAll(Path("a/trajectory.tum")), ReadAll(Path("b/trajectory.tum")));
}

TEST_F(WholeSystemTest, InAMirroredMapItClaimsNoPose) {
  PointMap map = LoadMap(kLogs + "sample_map.pcd").map;
  for (Eigen::Vector3f& p : map.points) p.y() = -p.y();
  WritePcd(Path("mirrored.pcd"), map);
  const Result result = Shell(PlaceCommand("refused", "mirrored.pcd"));
  EXPECT_EQ(result.code, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr("looking for the place"));
  const std::string poses = ReadAll(Path("refused/trajectory.tum"));
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 1) << poses;  // its heading
}

TEST_F(WholeSystemTest, RunningPipelineCanBeListedAndCommanded) {
  // Slow enough to be still running when a busy machine has got round to the last command.
  std::thread run([&] { EXPECT_EQ(Shell(RunCommand("out", "--realtime --speed 0.2")).code, 0); });
  const std::string evit = "XDG_RUNTIME_DIR=" + folder_.string() + " " + kEvit + " ";
  Result ps;
  EXPECT_TRUE(Eventually([&] {
    ps = Shell(evit + "ps");
    bool all = ps.code == 0;
    for (const char* service : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
      all = all && std::regex_search(ps.output, std::regex(std::string(service) + " +running +[0-9]+"));
    }
    return all;
  })) << ps.output;
  Result logs;
  EXPECT_TRUE(Eventually([&] {
    logs = Shell(evit + "logs window_optimizer");
    return logs.output.find("tracking") != std::string::npos;
  })) << logs.output;
  const Result restart = Shell(evit + "restart window_optimizer");
  EXPECT_EQ(restart.code, 0) << restart.output;
  const Result wrong = Shell(evit + "restart windows");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.output, HasSubstr("no command \"windows\"; there are: map_server, window_optimizer"));
  run.join();
  ExpectGood(Path("out/trajectory.tum"), 0.02, 0.8);
  EXPECT_EQ(Restarts("out"), 0);  // ordered restarts are not deaths
  EXPECT_THAT(Shell(evit + "ps").output, HasSubstr("neither `evit run` nor `evit up` is running"));
}

// Another driver begins to send while a run is at work.
TEST_F(WholeSystemTest, ASecondSenderThatComesLaterIsTold) {
  Result run;
  std::thread running([&] { run = Shell(RunCommand("out", "--realtime --speed 0.25")); });
  const std::string evit = "XDG_RUNTIME_DIR=" + folder_.string() + " " + kEvit + " ";
  EXPECT_TRUE(Eventually(
      [&] { return Shell(evit + "logs window_optimizer").output.find("tracking") != std::string::npos; }));
  const Result feed = Shell(kEvit + " feed --from " + kLogs + "sample.lcmlog --realtime --lcm-url " +
                            "'udpm://239.255.76.67:7667?ttl=0'");
  EXPECT_EQ(feed.code, 0) << feed.output;
  running.join();
  EXPECT_EQ(run.code, 2) << run.output;
  EXPECT_THAT(run.output, HasSubstr("two senders on EVENTS"));
  EXPECT_THAT(run.output, HasSubstr("--prefix NAME/"));
  EXPECT_TRUE(fs::exists(Path("out/report.json")));  // what it has is kept
}

TEST_F(WholeSystemTest, AnInterruptedCalibrationLeavesNothingBehind) {
  const std::string calibrate = kEvit + " calibrate --log " + kLogs + "sample.lcmlog";
  const std::string stop = "pkill -INT -f '^" + calibrate + " .*" + folder_.string() + "/'";
  const std::string begin = "XDG_RUNTIME_DIR=" + folder_.string() + " " + calibrate + " --map " + kLogs +
                            "sample_map.pcd --rig " + kLogs + "rig.textproto --initial-from " + kLogs +
                            "sample_truth.tum --out " + Path("rig.textproto");
  fs::create_directories(Path("there"));
  std::ofstream(Path("there/mine")) << "x";
  struct Case {
    const char *option, *work;
  };
  for (const Case& c : {Case{"", "rig.textproto.evt"}, Case{"--work ", "a/b/c"}, Case{"--work ", "there"}}) {
    const std::string option = c.option, work = c.work;
    std::string command = begin;
    if (!option.empty()) command.append(" ").append(option).append(Path(work));
    Result calibration;
    std::thread running([&] { calibration = Shell(command); });
    EXPECT_TRUE(Eventually([&] { return fs::exists(Path(work) + "/window_optimizer.log"); }));
    Shell(stop);
    running.join();
    EXPECT_EQ(calibration.code, 130) << calibration.output;
    EXPECT_FALSE(fs::exists(Path("rig.textproto"))) << calibration.output;
    EXPECT_FALSE(fs::exists(Path("rig.textproto.evt"))) << calibration.output;
    EXPECT_FALSE(fs::exists(Path("a"))) << calibration.output;
    EXPECT_TRUE(fs::exists(Path("there/mine"))) << calibration.output;
  }
}

TEST_F(WholeSystemTest, LcmToolsCanPlayAndRecord) {
  // The stock player feeds the three other services; the stock logger records their messages.
  const std::string bin = test::ProgramPath(""), rig = " --rig " + kLogs + "rig.textproto --config " +
                                                       test::SourcePath("config/tracker.textproto");
  const Trajectory truth = ReadTum(kLogs + "sample_truth.tum");
  const std::string line = TumLine(truth.front());
  const std::string url = "'udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304'";
  const auto start = [&](const std::string& program, const std::string& arguments) {
    return bin + program + arguments + " 2>" + Path(program + ".err") + " & ";
  };
  const auto wait_for = [](const std::string& file) {
    return "until [ -s " + file + " ]; do sleep 0.1; done; ";
  };
  std::string script =
      "export LCM_DEFAULT_URL=" + url + "; " + start("map_server", " --map " + kLogs + "sample_map.pcd") +
      "M=$!; " + start("frame_builder", rig) + "F=$!; " +
      start("window_optimizer", rig + " --initial-pose '" + line.substr(line.find(' ') + 1) + "'") + "W=$!; ";
  // Each says on stderr what it waits for once it listens.
  for (const char* program : {"map_server", "frame_builder", "window_optimizer"})
    script += wait_for(Path(std::string(program) + ".err"));
  script += "lcm-logger -q " + Path("result.lcmlog") + " & L=$!; sleep 1; lcm-logplayer --speed=0.5 " +
            kLogs +
            "sample.lcmlog >/dev/null; sleep 2; kill -TERM $L $M $F $W; wait $M && wait $F && wait $W";
  std::ofstream(Path("play.sh")) << script;
  const Result result = Shell("timeout 120 sh " + Path("play.sh"));
  EXPECT_EQ(result.code, 0) << result.output;
  const Result channels = Shell("strings -n 8 " + Path("result.lcmlog") + " | grep -c WINDOW_STATE");
  EXPECT_GT(std::atoi(channels.output.c_str()), 20) << channels.output;
}

// As with a disk that fills up at the end.
TEST_F(WholeSystemTest, APictureThatCannotBeWrittenCostsNoResult) {
  fs::create_directories(Path("out/trajectory.png/in_use"));  // a folder, which no picture can replace
  const Result result = Shell(RunCommand("out"));
  EXPECT_EQ(result.code, 1) << result.output;
  EXPECT_THAT(result.output, HasSubstr("trajectory.png: is not a file that can be replaced"));
  ExpectGood(Path("out/trajectory.tum"), 0.02, 0.8);
  EXPECT_TRUE(fs::exists(Path("out/report.json")));
  EXPECT_TRUE(fs::exists(Path("out/consistency.png")));
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
      {RunCommand("out", "--record " + folder_.string()), "--record"},
      {kEvit + " import vector " + kLogs + " --sequence nothing --out " + Path("x.lcmlog"),
       "sequences found there"},
      {kEvit + " run --log " + kLogs + "sample.lcmlog", "missing: --rig, --out"},
      {kEvit + " run --log x", "--log x: there is no such file"},
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
