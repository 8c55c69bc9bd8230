#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

#include "common/bus/lcm_bus.h"
#include "common/service/runner.h"
#include "common/service/stop_signals.h"
#include "procman/deputy.h"
#include "procman/script_runner.h"
#include "tools/evit/commands.h"
#include "tools/evit/data_file.h"
#include "tools/evit/deployment_files.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/run/alone_on_bus.h"
#include "tools/run/local_network.h"
#include "tools/run/run_file.h"

namespace evit::commands {
namespace {

// LCM's own default, without the private network that no variable means: ttl=0 keeps it on this host.
constexpr char kOpenUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

struct UpOptions {
  std::string file, script, deputy, logs, lcm_url;
};

// The commands of one deputy; where the file knows only one, its.
std::vector<procman::ProcmanCommand> CommandsOf(const procman::Deployment& deployment, const UpOptions& o,
                                                std::string* deputy) {
  std::set<std::string> deputies;
  for (const procman::ProcmanCommand& command : deployment.commands) deputies.insert(command.deputy);
  std::string known;
  for (const std::string& name : deputies) known += (known.empty() ? "" : ", ") + name;
  if (o.deputy.empty() && deputies.size() != 1) {
    throw std::runtime_error(o.file + " has commands of several deputies (" + known +
                             "); choose one with --deputy");
  }
  *deputy = o.deputy.empty() ? *deputies.begin() : o.deputy;
  if (deputies.count(*deputy) == 0) {
    throw std::runtime_error(o.file + " has no command of deputy " + *deputy + "; it has those of: " + known);
  }
  std::vector<procman::ProcmanCommand> commands;
  for (const procman::ProcmanCommand& command : deployment.commands) {
    if (command.deputy == *deputy) commands.push_back(command);
  }
  return commands;
}

// What evit.procman needs beside what only the user can know.
void SetDefaults(const std::filesystem::path& logs) {
  setenv("EVIT_CONFIG", DataFile("config/tracker.textproto").c_str(), 0);
  setenv("EVIT_START", "", 0);  // the place is looked for
  if (std::getenv("EVIT_STATE") != nullptr) return;
  // For restarts of services: an earlier deployment's state is none of this one's.
  const std::filesystem::path state = logs / "state";
  std::filesystem::remove_all(state);
  std::filesystem::create_directories(state);
  setenv("EVIT_STATE", state.c_str(), 1);
}

// Programs started outside this process's network would send and hear nothing.
void SayIsolated() {
  std::printf(
      "the services have a network of their own, as this host has no multicast route through lo; evit feed, "
      "ps, top, logs and monitor join it. For a driver or tools of your own, set in both shells: "
      "export LCM_DEFAULT_URL='%s'\n",
      kOpenUrl);
  std::fflush(stdout);
}

// As it is named, or a deployment that comes with EVIT.
std::string DeploymentFile(const std::string& name) {
  const bool plain = name.find('/') == std::string::npos && !std::filesystem::exists(name);
  return plain ? DataFile("procman/" + name) : name;
}

void Up(const UpOptions& o) {
  const procman::Deployment deployment = procman::LoadDeployment(DeploymentFile(o.file));
  std::string deputy_id;
  const std::vector<procman::ProcmanCommand> commands = CommandsOf(deployment, o, &deputy_id);
  RequireOutputFolder("--logs", o.logs);
  std::filesystem::create_directories(o.logs);
  SetDefaults(std::filesystem::absolute(o.logs));
  RequireFiles(deployment, o.script, deputy_id);

  const std::string url = ResolveLcmUrl(o.lcm_url);
  std::unique_ptr<run::RunFile> run_file;
  bool own_network = false;
  if (run::IsLocalBus(o.lcm_url)) {
    own_network = run::EnsureLocalMulticast(url);
    run_file = std::make_unique<run::RunFile>(o.logs);
  }
  setenv("LCM_DEFAULT_URL", url.c_str(), 1);  // for the commands
  const auto bus = OpenLcmBus(url);
  if (own_network) SayIsolated();
  if (!own_network) run::RequireAlone(bus.get(), deputy_id);
  // What the commands say is shown as it comes over the bus, like in any sheriff.
  bus->Subscribe(procman::kPmOutput, [&](const std::string&, const std::uint8_t* data, std::size_t size) {
    procman_lcm::output_t message;
    if (!procman::DecodeProcman(data, size, &message) || message.deputy_name != deputy_id) return;
    std::printf("%s: %s", message.command_id.empty() ? deputy_id.c_str() : message.command_id.c_str(),
                message.text.c_str());
    std::fflush(stdout);
  });
  const std::filesystem::path programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  procman::Deputy deputy(bus.get(), deputy_id, commands, {programs, o.logs});
  procman::ScriptRunner runner(deployment, &deputy.supervisor());
  const StopSignals signals;
  runner.Run(o.script);
  bool running = false;
  while (!signals.received()) {
    bus->Poll(20);
    runner.Tick();
    deputy.Tick();
    if (runner.done() && !running) {
      std::printf("script \"%s\" has run; evit ps shows the commands, Ctrl-C ends them\n", o.script.c_str());
      std::fflush(stdout);
      running = true;
    }
  }
  std::printf("stopping\n");
  deputy.supervisor().StopAll();
}

}  // namespace

void AddUpCommand(CLI::App* app) {
  auto o = std::make_shared<UpOptions>();
  CLI::App* up =
      app->add_subcommand("up", "Run a procman deployment headless: starts, watches and stops its commands");
  up->add_option("file", o->file, "Procman file, either dialect; evit.procman and evit.pmd come with EVIT")
      ->required();
  up->add_option("script", o->script, "Script of it to run, e.g. replay or robot")->required();
  up->add_option("--deputy", o->deputy, "Run this deputy's commands (default: the only one of the file)");
  up->add_option("--logs", o->logs, "Folder for NAME.log and what restarts need")->default_val("evit-logs");
  up->add_option("--lcm-url", o->lcm_url,
                 "Bus (default: LCM_DEFAULT_URL, else one that never leaves this host)");
  up->footer(
      "Example: EVIT_MAP=map.pcd EVIT_RIG=rig.textproto evit up evit.procman robot\n"
      "Commands inherit this environment; EVIT_CONFIG and EVIT_STATE get defaults. EVIT_START=\"x y z qx qy "
      "qz qw\"\n"
      "gives a start pose; without it the tracker finds its place. Programs are searched beside evit, then "
      "on PATH.\n"
      "A command that dies is restarted if its auto_respawn is true.");
  up->callback([o] { Up(*o); });
}

}  // namespace evit::commands
