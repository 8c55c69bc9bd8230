#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/geometry/pose_text.h"
#include "tools/doctor/doctor.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/evit/place_options.h"
#include "tools/monitor/monitor_child.h"
#include "tools/run/run.h"

namespace evit::commands {
namespace {

// After a run that did not track: what examining the recording finds first, where it finds something.
void SayWhy(const run::RunJob& job) {
  doctor::Patient patient;
  patient.log = job.log, patient.rig = job.rig, patient.map = job.map;
  patient.truth = job.truth, patient.start = job.initial_pose;
  std::string options =
      " --log " + job.log + " --rig " + job.rig + (job.map.empty() ? "" : " --map " + job.map);
  if (!job.truth.empty()) options += " --truth " + job.truth;
  try {
    const diagnosis::Findings findings = doctor::Examine(patient, [](double) {});
    if (!findings.empty() && findings.front().severity != diagnosis::Severity::kGood) {
      std::fprintf(stderr, "what the doctor finds first: %s\n  remedy: %s\n", findings.front().what.c_str(),
                   findings.front().remedy.c_str());
    }
    std::fprintf(stderr, "all that it looks at: evit doctor%s\n", options.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "evit doctor cannot look at it: %s\n", error.what());
  }
}

struct RunOptions {
  run::RunJob job;
  std::string pose, from, seconds;
  bool realtime = false, lossless = false, monitor = false;
  monitor::MonitorOptions page;
};

void AddRunFiles(CLI::App* run, RunOptions* o) {
  run->add_option("--log", o->job.log, "LCM log with EVENTS and IMU (evit import)")->required();
  run->add_option("--map", o->job.map, "Semi-dense map: PCD, PLY or text, metres, z up");
  run->add_option("--photometric-map", o->job.photometric_map,
                  "For method EVPT: PLY with intensities (evit map photometric); --map is optional then");
  run->add_option("--rig", o->job.rig, "Calibration, e.g. config/vector/rig.textproto")->required();
  run->add_option("--config", o->job.config,
                  "Tracker settings, e.g. config/evt.textproto (default: EVIT's, see evit config show)");
  auto* pose = run->add_option(
      "--initial-pose", o->pose,
      "Body in the map at the start: \"x y z qx qy qz qw\"; without a pose the place is looked for");
  auto* from = run->add_option("--initial-from", o->from,
                               "Take the pose from this ground truth (TUM), and score against it");
  pose->excludes(from);
  AddPlaceOptions(run, &o->job.place);
  run->add_option("--truth", o->job.truth, "Truth (TUM) to score against");
  run->add_option("--out", o->job.out, "Folder for the results")->required();
}

void AddPlayback(CLI::App* run, RunOptions* o) {
  auto* realtime = run->add_flag("--realtime", o->realtime,
                                 "Play in real time; nothing waits for slow services, losses are counted");
  run->add_flag("--lossless", o->lossless,
                "As fast as the services can follow; bit-identical every time (default)")
      ->excludes(realtime);
  run->add_option("--speed", o->job.play.speed, "With --realtime: this many times faster")
      ->check(CLI::PositiveNumber);
  run->add_option("--loops", o->job.play.loops,
                  "With --realtime: play the log this many times and record the memory (soak test)")
      ->check(CLI::PositiveNumber);
  run->add_option("--seconds", o->seconds, "A:B in s, play only this part of the log");
  run->add_option("--record", o->job.record,
                  "LCM log to write the keyframes (surfaces, IMU) and windows to, 15 to 30 MB/s");
  run->add_flag("--monitor", o->monitor,
                "Show it in the browser while it runs, and its end until Ctrl-C (see evit monitor)");
  run->add_option("--monitor-port", o->page.web.port, "Port of that page")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
}

void AddTolerances(CLI::App* run, RunOptions* o) {
  run->add_option("--log-prefix", o->job.play.log_prefix,
                  "Prefix of EVENTS and IMU in the log (default: found, where there is only one)");
  run->add_flag("--allow-truncated", o->job.tolerate.truncated,
                "Run the complete messages of a log that was cut off");
  run->add_flag("--any-rig", o->job.tolerate.any_rig,
                "Run even where the rig's T_body_camera looks like its inverse");
  run->add_flag("--any-imu", o->job.tolerate.any_imu, "Run even where the IMU's units or axes look wrong");
}

void AddBus(CLI::App* run, RunOptions* o) {
  run->add_option("--lcm-url", o->job.lcm_url,
                  "Bus (default: LCM_DEFAULT_URL, else one that never leaves this host)");
  run->add_option("--prefix", o->job.prefix, "Prefix of all channels, so that several pipelines share a bus");
}

// Completes the job from what was typed.
void FinishJob(RunOptions* o) {
  run::RunJob& job = o->job;
  RequireOutputFolder("--out", job.out);
  if (!o->pose.empty()) job.initial_pose = ParsePose("--initial-pose", o->pose);
  job.initial_from = o->from;
  job.tolerate.no_score = job.truth.empty();
  if (job.truth.empty()) job.truth = o->from;
  if (!o->seconds.empty()) job.play.seconds = ParseSeconds(o->seconds);
  job.play.lossless = !o->realtime;
  if (job.play.lossless && job.play.loops > 1) throw std::runtime_error("--loops needs --realtime");
  if (job.play.loops > 1 && !job.initial_pose && job.initial_from.empty())
    throw std::runtime_error("--loops needs --initial-pose or --initial-from: each loop starts there");
  if (!job.record.empty()) {
    RequireLogOutput("--record", job.record);
    RequireNotAnInput(
        "--record", job.record,
        {job.log, job.map, job.photometric_map, job.rig, job.config, job.truth, job.initial_from});
  }
  job.command = CommandLineOfThis();
}

// Opens the page that shows the run in the browser.
void ShowPage(RunOptions* o, std::optional<monitor::MonitorChild>* shown) {
  o->page.map = o->job.map;
  o->page.rig = o->job.rig;
  o->page.prefix = o->job.prefix;
  shown->emplace(o->page, o->job.lcm_url);
  monitor::SayUrl(o->page, "");
  monitor::OpenBrowser(monitor::PageUrl(o->page));
}

void RunAndShow(RunOptions* o) {
  FinishJob(o);
  const run::RunJob& job = o->job;
  std::optional<monitor::MonitorChild> shown;
  if (o->monitor) ShowPage(o, &shown);
  const int code = run::Run(job);
  if (code == 2) SayWhy(job);
  if (shown && code != 130) {
    std::printf("the run is over; the monitor shows its end until Ctrl-C\n");
    std::fflush(stdout);
    shown->WaitForSignal();
  }
  if (code != 0) throw CLI::RuntimeError(code);
}

}  // namespace

void AddRunCommand(CLI::App* app) {
  auto o = std::make_shared<RunOptions>();
  CLI::App* run =
      app->add_subcommand("run", "Track a recorded log: starts the four services, scores the result");
  AddRunFiles(run, o.get());
  AddPlayback(run, o.get());
  AddTolerances(run, o.get());
  AddBus(run, o.get());
  run->footer(
      "Example: evit run --log desk.lcmlog --map desk/map.pcd --rig desk/rig.textproto --initial-from "
      "desk/truth.tum "
      "--out result\n"
      "Exit code: 0 tracking at the end (times_lost in report.json: how often it was LOST before); 1 could "
      "not run, or a\n"
      "result could not be written; 2 LOST at the end, never tracking, or tracked less than half of the "
      "time;\n"
      "3 tracked, but --truth has too few poses for a score; 130 interrupted.");
  run->callback([o] { RunAndShow(o.get()); });
}

}  // namespace evit::commands
