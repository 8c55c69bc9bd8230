#include "tools/mapping/map_edit.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/map/map_file.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/mapping/build_report.h"

namespace evit::commands {
namespace {

struct MapEdit {
  std::vector<std::string> in;
  std::string out, box, transform;
  double scale = 1, voxel = 0.004;
  bool outside = false;
};

void WriteEdited(const MapEdit& edit, const PointMap& map) {
  if (map.points.empty()) throw std::runtime_error(edit.out + ": no point would be left; not written");
  WriteMap(edit.out, map);
  std::printf("%s: %zu points\n", edit.out.c_str(), map.points.size());
}

std::shared_ptr<MapEdit> AddFiles(CLI::App* command, bool several) {
  auto edit = std::make_shared<MapEdit>();
  CLI::Option* in = command->add_option("IN", edit->in, several ? "Maps to read" : "Map to read")->required();
  if (!several) in->expected(1);
  command->add_option("--out", edit->out, "Map to write: .pcd or .ply")
      ->required()
      ->check(mapping::CannotWriteMap);
  return edit;
}

}  // namespace

void AddMapEdits(CLI::App* map) {
  CLI::App* merge = map->add_subcommand("merge", "Make one map of several in the same frame");
  auto m = AddFiles(merge, true);
  merge->add_option("--voxel", m->voxel, "Keep one point per cell of this size, m; 0: all")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  merge->footer("Example: evit map merge left.pcd right.pcd --out room.pcd");
  merge->callback([m] {
    std::vector<PointMap> maps;
    for (const std::string& path : m->in) maps.push_back(LoadMap(path).map);
    WriteEdited(*m, mapping::Merge(maps, m->voxel));
  });

  CLI::App* crop = map->add_subcommand("crop", "Keep the part of a map that lies in a box");
  auto c = AddFiles(crop, false);
  crop->add_option("--box", c->box, "x0:x1,y0:y1,z0:z1 in m; an end left out is open")->required();
  crop->add_flag("--outside", c->outside, "Keep what lies outside the box instead");
  crop->footer("Example: evit map crop room.pcd --box :,:,0.1:2 --out without_floor.pcd");
  crop->callback([c] {
    PointMap cropped = LoadMap(c->in.front()).map;
    mapping::Crop(mapping::ParseBox("--box", c->box), c->outside, &cropped);
    WriteEdited(*c, cropped);
  });

  CLI::App* transform = map->add_subcommand("transform", "Move, turn and scale a map");
  auto t = AddFiles(transform, false);
  transform->add_option("--transform", t->transform,
                        "16 numbers, row-major 4x4: moves the points (after scaling)");
  transform->add_option("--scale", t->scale, "Multiply coordinates, e.g. 0.001 for millimetres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  transform->footer(
      "Example: evit map transform scan.pcd --transform \"0 -1 0 0 1 0 0 0 0 0 1 0.5 0 0 0 1\" --out "
      "turned.pcd");
  transform->callback([t] {
    PointMap moved = LoadMap(t->in.front()).map;
    mapping::Transform(t->transform.empty() ? SE3() : ParseTransform("--transform", t->transform), t->scale,
                       &moved);
    WriteEdited(*t, moved);
  });
}

}  // namespace evit::commands
