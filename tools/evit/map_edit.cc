#include "tools/mapping/map_edit.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/geometry/degrees.h"
#include "common/map/map_file.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/mapping/build_report.h"
#include "tools/mapping/gravity_direction.h"

namespace evit::commands {
namespace {

struct MapEdit {
  std::vector<std::string> in;
  std::string out, box, transform, upright, truth, truth_out;
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

// Says how, so that other poses can follow.
SE3 TurnUpright(const MapEdit& edit) {
  Trajectory truth = ReadTum(edit.truth);
  SE3 T = mapping::UprightRotation(edit.upright, truth, edit.truth);
  std::printf("turned by %.2f deg; for other poses: --T-map-world \"",
              AngularDistance(T.q, {1, 0, 0, 0}) * kDegreesPerRadian);
  for (int row = 0; row < 3; ++row)
    std::printf("%.9f %.9f %.9f 0 ", T.R()(row, 0), T.R()(row, 1), T.R()(row, 2));
  std::printf("0 0 0 1\"\n");
  if (edit.truth_out.empty()) return T;
  for (StampedPose& pose : truth) {
    pose.pose = T * pose.pose;
    pose.pose.p *= edit.scale;
  }
  WriteTum(edit.truth_out, truth);
  return T;
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
    RequireOutput("--out", m->out);
    RequireNotAnInput("--out", m->out, m->in);
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
    RequireOutput("--out", c->out);
    RequireNotAnInput("--out", c->out, c->in);
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
  CLI::Option* upright = transform->add_option(
      "--upright", t->upright, "LCM log with IMU: turn the map so that z points up, by gravity and --truth");
  CLI::Option* truth =
      transform->add_option("--truth", t->truth, "TUM: the body's poses in the map, of that log");
  upright->needs(truth);
  truth->needs(upright);
  upright->excludes("--transform");
  transform->add_option("--truth-out", t->truth_out, "TUM file to write: those poses in the turned map")
      ->needs(upright);
  transform->footer(
      "Example: evit map transform scan.pcd --transform \"0 -1 0 0 1 0 0 0 0 0 1 0.5 0 0 0 1\" --out "
      "turned.pcd");
  transform->callback([t] {
    RequireOutput("--out", t->out);
    RequireNotAnInput("--out", t->out, t->in);
    RequireOutput("--truth-out", t->truth_out);
    RequireNotAnInput("--truth-out", t->truth_out, {t->truth, t->out, t->in.front()});
    PointMap moved = LoadMap(t->in.front()).map;
    SE3 T = t->transform.empty() ? SE3() : ParseTransform("--transform", t->transform);
    if (!t->upright.empty()) T = TurnUpright(*t);
    mapping::Transform(T, t->scale, &moved);
    WriteEdited(*t, moved);
  });
}

}  // namespace evit::commands
