#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/service/stop_signals.h"
#include "procman/sheriff.h"
#include "tools/evit/commands.h"
#include "tools/evit/pipeline_bus.h"
#include "tools/evit/service_log.h"
#include "tools/run/local_network.h"
#include "tools/run/run_file.h"

namespace evit::commands {
namespace {

constexpr auto kPatience = std::chrono::seconds(5);

std::string Condition(const procman_lcm::cmd_status_t& status) {
  if (status.pid != 0) return "running";
  if (status.actual_runid == 0) return "not started";
  return status.exit_code == 0 ? "stopped" : "ended with " + std::to_string(status.exit_code);
}

void Ps(const std::string& lcm_url) {
  const auto bus = OpenBusOfPipeline(lcm_url);
  procman::Sheriff sheriff(bus.get());
  const auto& deputies = sheriff.Look(kPatience);
  if (deputies.empty()) {
    throw std::runtime_error("no deputy answered; is `evit run` or `evit up` running on the same LCM URL?");
  }
  std::printf("%-12s %-20s %-16s %8s %6s %9s\n", "DEPUTY", "COMMAND", "STATE", "PID", "CPU", "MEMORY");
  for (const auto& [name, info] : deputies) {
    for (const auto& status : info.cmds) {
      std::printf("%-12s %-20s %-16s %8d %4.0f %% %6.0f MB\n", name.c_str(), status.cmd.command_id.c_str(),
                  Condition(status).c_str(), status.pid, 100.0 * static_cast<double>(status.cpu_usage),
                  static_cast<double>(status.mem_rss_bytes) / (1 << 20));
    }
  }
}

struct LogOptions {
  std::string command, lcm_url;
  int lines = 50;
  bool follow = false;
};

// The end of a log file; false where there is none.
bool PrintLogFile(const std::string& path, int lines) {
  std::ifstream file(path);
  if (!file) return false;
  std::deque<std::string> last;
  for (std::string line; std::getline(file, line);) {
    last.push_back(line);
    if (last.size() > static_cast<std::size_t>(lines)) last.pop_front();
  }
  for (const std::string& line : last) std::printf("%s\n", line.c_str());
  std::fflush(stdout);
  return true;
}

// Where the newest pipeline on this host's own bus says that its logs are.
std::string LogFileOfRunning(const std::string& id) {
  const auto running = run::FindRunning();
  return running ? (std::filesystem::path(running->logs) / (id + ".log")).string() : "";
}

// The log file by what its deputy says: any of its processes leads to it. Throws where no deputy knows `id`.
std::string LogFileByBus(procman::Sheriff* sheriff, const std::string& id) {
  bool known = false;
  std::string path;
  for (const auto& [name, info] : sheriff->Look(kPatience)) {
    const auto has = [&](const auto& status) { return status.cmd.command_id == id; };
    if (std::none_of(info.cmds.begin(), info.cmds.end(), has)) continue;
    known = true;
    for (const auto& status : info.cmds) {
      if (path.empty() && status.pid != 0) path = LogFileOfCommand(status.pid, id);
    }
  }
  if (!known) throw std::runtime_error("there is no command \"" + id + "\"; evit ps lists the commands");
  return path;
}

void Logs(const LogOptions& o) {
  bool local = run::IsLocalBus(o.lcm_url) && PrintLogFile(LogFileOfRunning(o.command), o.lines);
  if (local && !o.follow) return;
  const auto bus = OpenBusOfPipeline(o.lcm_url);
  procman::Sheriff sheriff(bus.get());
  const std::string path = LogFileByBus(&sheriff, o.command);
  local = local || PrintLogFile(path, o.lines);
  if (local && !o.follow) return;
  if (!local && !o.follow) {
    throw std::runtime_error(
        "its log file is not found: its pipeline runs on another host or for another user, or all its "
        "services have stopped; --follow shows its output from now on");
  }
  sheriff.OnOutput([&](const procman_lcm::output_t& message) {
    if (message.command_id != o.command) return;
    std::printf("%s", message.text.c_str());
    std::fflush(stdout);
  });
  const StopSignals signals;
  while (!signals.received()) bus->Poll(100);
}

void AddOrder(CLI::App* app, const char* name, const char* help, procman::Sheriff::Order order) {
  struct Options {
    std::string command, lcm_url;
  };
  auto o = std::make_shared<Options>();
  CLI::App* sub = app->add_subcommand(name, help);
  sub->add_option("command", o->command, "Its id, as listed by evit ps")->required();
  sub->add_option("--lcm-url", o->lcm_url, "Bus (default: that of the pipeline running here)");
  sub->footer(std::string("Example: evit ") + name + " map_server");
  sub->callback([o, order] {
    const auto bus = OpenBusOfPipeline(o->lcm_url);
    // stop_time_allowed may pass before it has ended.
    procman::Sheriff(bus.get()).Give(order, o->command, std::chrono::seconds(15));
  });
}

}  // namespace

void AddProcmanCommands(CLI::App* app) {
  auto url = std::make_shared<std::string>();
  CLI::App* ps = app->add_subcommand("ps", "List the processes of a running pipeline (PM_INFO)");
  ps->add_option("--lcm-url", *url, "Bus (default: that of the pipeline running here)");
  ps->footer("Example: evit ps");
  ps->callback([url] { Ps(*url); });

  AddOrder(app, "start", "Start a command of a running pipeline (PM_ORDERS)",
           procman::Sheriff::Order::kStart);
  AddOrder(app, "stop", "Stop a command of a running pipeline (PM_ORDERS)", procman::Sheriff::Order::kStop);
  AddOrder(app, "restart", "Restart a command of a running pipeline (PM_ORDERS)",
           procman::Sheriff::Order::kRestart);

  auto o = std::make_shared<LogOptions>();
  CLI::App* logs =
      app->add_subcommand("logs", "Show the output of a command of a running pipeline (PM_OUTPUT)");
  logs->add_option("command", o->command, "Its id, as listed by evit ps")->required();
  logs->add_option("-n,--lines", o->lines, "Lines of its log file to print")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  logs->add_flag("-f,--follow", o->follow, "Keep printing new output until Ctrl-C");
  logs->add_option("--lcm-url", o->lcm_url, "Bus (default: that of the pipeline running here)");
  logs->footer("Example: evit logs window_optimizer --lines 100 --follow");
  logs->callback([o] { Logs(*o); });
}

}  // namespace evit::commands
