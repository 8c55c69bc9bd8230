#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "tools/evit/commands.h"
#include "tools/evit/output_names.h"
#include "tools/formats/rgbd/rgbd_folder.h"
#include "tools/terminal/progress_bar.h"

namespace evit::commands {
namespace {

// Empty: fine.
std::string NewPly(const std::string& path) {
  const std::filesystem::path file(path);
  if (file.extension() != ".ply")
    return path + ": photometric maps are written as PLY; give a name that ends in .ply";
  return "";
}

}  // namespace

void AddMapPhotometric(CLI::App* map) {
  struct Options {
    std::string folder, out;
    RgbdFusion::Settings fusion;
    std::size_t every = 1;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = map->add_subcommand(
      "photometric", "Photometric map (points with intensity) from posed RGB-D images, for EVPT");
  command->option_defaults()->always_capture_default();
  command->add_option("DIR", o->folder, "Folder of images/, depth/ (16 bit, mm), poses.txt and K.txt")
      ->required();
  command->add_option("--out", o->out, "PLY to write")->required()->check(NewPly);
  command->add_option("--voxel", o->fusion.voxel, "One point per cell of this size, m")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-depth", o->fusion.max_depth, "Leave out what is farther from the camera, m")
      ->check(CLI::PositiveNumber);
  command->add_option("--every", o->every, "Use every Nth image")->check(CLI::PositiveNumber);
  command->footer("Example: evit map photometric desk/rgbd --out desk.ply");
  command->callback([o] {
    RequireOutput("--out", o->out);
    const formats::RgbdFolder folder(o->folder);
    RgbdFusion fusion(o->fusion);
    {
      terminal::ProgressBar bar("fusing");
      for (std::size_t k = 0; k < folder.size(); k += o->every) {
        bar.Show(static_cast<double>(k) / static_cast<double>(folder.size()),
                 std::to_string(fusion.size()) + " points");
        fusion.Add(folder.Load(k));
      }
      bar.Show(1, std::to_string(fusion.size()) + " points");
    }
    const PhotometricMap result = fusion.Finish();
    if (result.points.empty()) {
      throw std::runtime_error(o->folder + ": no pixel has a depth within " +
                               std::to_string(o->fusion.max_depth) +
                               " m; are the depth images in millimetres?");
    }
    WritePhotometricMap(o->out, result);
    std::printf("%s: %zu points from %zu images\n", o->out.c_str(), result.points.size(),
                (folder.size() + o->every - 1) / o->every);
  });
}

}  // namespace evit::commands
