#include <memory>

#include "common/config/rig_file.h"
#include "tools/evit/data_file.h"
#include "tools/evit/import_options.h"
#include "tools/evit/options.h"
#include "tools/formats/vector/sequence_import.h"

namespace evit::commands {

void AddImportVector(CLI::App* import) {
  struct Options {
    ImportOptions shared;
    std::string folder, name, rig;
  };
  auto o = std::make_shared<Options>();
  CLI::App* vector = import->add_subcommand("vector", "A sequence in the VECtor benchmark's own files");
  vector->add_option("DIR", o->folder, "Folder with NAME1.synced.left_event.hdf5, .imu.txt and .gt.txt")
      ->required();
  vector->add_option("--sequence", o->name, "NAME, e.g. desk_normal (default: the only one there)");
  vector->add_option("--rig", o->rig, "Calibration (default: config/vector/rig.textproto)");
  o->shared.AddTo(vector);
  vector->footer("Example: evit import vector ~/vector/desk_normal --out desk.lcmlog");
  vector->callback([o] {
    formats::SequenceImport job;
    o->shared.Apply(&job);
    job.folder = o->folder;
    job.name = o->name.empty() ? formats::OnlySequence(o->folder) : o->name;
    job.rig = LoadRig(o->rig.empty() ? DataFile("config/vector/rig.textproto") : o->rig);
    RunImport(job.name, job, job.name + "1.synced.gt.txt",
              [&](const auto& progress) { return formats::ImportSequence(job, progress); });
  });
}

}  // namespace evit::commands
