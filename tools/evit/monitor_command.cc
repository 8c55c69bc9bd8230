#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "tools/evit/commands.h"
#include "tools/monitor/monitor_child.h"
#include "tools/monitor/monitor_process.h"
#include "tools/monitor/top_terminal.h"

namespace evit::commands {

void AddMonitorCommand(CLI::App* app) {
  struct Options {
    monitor::MonitorOptions monitor;
    std::string lcm_url;
    bool open = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command =
      app->add_subcommand("monitor", "Show a pipeline at work in the browser: map, pose, events, health");
  command->add_option("--port", o->monitor.web.port, "Port to serve the page on")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  command
      ->add_option("--bind", o->monitor.web.bind, "Address to serve on; 0.0.0.0: every address of this host")
      ->check(CLI::ValidIPV4)
      ->capture_default_str();
  command->add_flag("--read-only", o->monitor.read_only, "Viewers see everything and change nothing");
  command->add_option("--map", o->monitor.map,
                      "Map to show (PCD, PLY or text); default: map_server's, where it runs on this host, "
                      "else what it tells the tracker");
  command->add_option("--rig", o->monitor.rig,
                      "Calibration of the camera shown; default: the pipeline's, where it runs on this host, "
                      "else learnt from its queries");
  command->add_option("--allow-origin", o->monitor.web.origins,
                      "Also let pages of this origin connect, e.g. https://app.foxglove.dev");
  command->add_flag("--open", o->open, "Open the page in the browser, where there is a desktop");
  command->add_option("--lcm-url", o->lcm_url,
                      "Bus (default: LCM_DEFAULT_URL, else that of the pipeline running here, now or later)");
  command->add_option("--prefix", o->monitor.prefix, "Prefix of all channels");
  command->footer("Example: evit monitor   (then open http://127.0.0.1:8080)");
  command->callback([o] {
    monitor::SayUrl(o->monitor, "  (Ctrl-C ends it)");
    if (o->open) monitor::OpenBrowser(monitor::PageUrl(o->monitor));
    if (monitor::MonitorProcess(o->monitor, o->lcm_url).Run() != 0) throw CLI::RuntimeError(1);
  });
}

void AddTopCommand(CLI::App* app) {
  auto o = std::make_shared<monitor::TopOptions>();
  CLI::App* command = app->add_subcommand("top", "Show a pipeline at work in the terminal");
  command->add_flag("--once", o->once, "One screen as plain text, then the end");
  command->add_option("--pid", o->pid, "Process of the evit run or evit up to show, where several run here");
  command->add_option("--lcm-url", o->lcm_url, "Bus (default: that of the pipeline running here)");
  command->add_option("--prefix", o->prefix, "Prefix of all channels");
  command->footer("Example: evit top");
  command->callback([o] { monitor::ShowTop(*o); });
}

}  // namespace evit::commands
