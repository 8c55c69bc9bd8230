#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "common/config/config.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/progress.h"
#include "tools/vector/sequence_import.h"

namespace evit {

void AddImportCommand(CLI::App* app) {
  struct Options {
    std::string folder, name, out, rig, transform, seconds;
  };
  auto o = std::make_shared<Options>();
  CLI::App* parent =
      app->add_subcommand("import", "Turn a recorded sequence into an LCM log")->require_subcommand(1);
  CLI::App* vector = parent->add_subcommand("vector", "A sequence in the VECtor benchmark's own files");
  vector->add_option("DIR", o->folder, "Folder with NAME1.synced.left_event.hdf5, .imu.txt and .gt.txt")
      ->required();
  vector->add_option("--sequence", o->name, "NAME, e.g. desk_normal")->required();
  vector->add_option("--out", o->out, "Log to write; the body's truth goes to FILE.truth.tum")->required();
  vector->add_option("--rig", o->rig, "Calibration (default: config/vector/rig.textproto)");
  vector->add_option(
      "--T-map-world", o->transform,
      "16 numbers, row-major 4x4: moves the ground truth's world into the map's frame (default: same)");
  vector->add_option("--seconds", o->seconds, "A:B, take only this part (seconds after the first event)");
  vector->callback([o] {
    SequenceImport job;
    job.folder = o->folder;
    job.name = o->name;
    job.out = o->out;
    job.rig = LoadRig(o->rig.empty() ? ConfigFile("vector/rig.textproto") : o->rig);
    if (!o->transform.empty()) job.T_map_world = ParseTransform("--T-map-world", o->transform);
    if (!o->seconds.empty()) job.seconds = ParseSeconds(o->seconds);
    ImportSummary s;
    {
      ProgressBar bar("importing " + o->name);
      s = ImportSequence(job, [&](double share) { bar.Show(share); });
    }
    std::printf(
        "%s: %.1f s, %lld events in %lld packets (%.2f million/s), %lld IMU samples, %lld truth poses\n",
        o->out.c_str(), s.seconds, static_cast<long long>(s.n_events), static_cast<long long>(s.n_packets),
        1e-6 * static_cast<double>(s.n_events) / s.seconds, static_cast<long long>(s.n_imu),
        static_cast<long long>(s.n_truth));
    if (s.n_truth == 0)
      std::printf("no ground truth (%s1.synced.gt.txt): runs cannot be scored\n", o->name.c_str());
  });
}

}  // namespace evit
