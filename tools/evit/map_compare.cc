#include "tools/mapping/map_compare.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/map/map_file.h"
#include "common/text/format_text.h"
#include "tools/evit/commands.h"

namespace evit::commands {
namespace {

PointMap LoadPoints(const std::string& path) {
  PointMap map = LoadMap(path).map;
  if (map.points.empty()) throw std::runtime_error(path + ": holds no points");
  return map;
}

std::optional<mapping::PathDistance> PathOf(const std::string& poses) {
  if (poses.empty()) return std::nullopt;
  const Trajectory path = ReadTum(poses);
  if (path.empty()) throw std::runtime_error(poses + ": holds no poses");
  return mapping::PathDistance(path);
}

PointMap InRange(const PointMap& map, const mapping::PathDistance* path, double min_m, double max_m,
                 const std::string& file) {
  if (path == nullptr) return map;
  if (min_m >= max_m)
    throw std::runtime_error(FormatText("--min-distance %g is not below --max-distance %g", min_m, max_m));
  PointMap part = path->Between(map, min_m, max_m);
  if (part.points.empty()) {
    throw std::runtime_error(
        FormatText("%s: holds no points %g to %g m from the path; is it in the poses' frame?", file.c_str(),
                   min_m, max_m));
  }
  return part;
}

}  // namespace

void AddMapCompare(CLI::App* map) {
  struct Options {
    std::string map, reference, poses;
    double limit = 0.02, min_distance = 0, max_distance = 1000;
    bool json = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = map->add_subcommand(
      "compare",
      "How far a map's points lie from those of another in the same frame, and what it lacks of them");
  command->add_option("MAP", o->map, "Map to judge")->required();
  command->add_option("REFERENCE", o->reference, "Map to judge it by: dense and exact")->required();
  command->add_option("--limit", o->limit, "m; what lies farther off counts as wrong, or as missing")
      ->check(CLI::Range(0.001, 0.2))
      ->capture_default_str();
  command->add_option("--poses", o->poses, "TUM file of the camera's path (any frame on the body will do)");
  command
      ->add_option("--min-distance", o->min_distance,
                   "m; only points, of both maps, at least so far from the path")
      ->check(CLI::NonNegativeNumber)
      ->needs("--poses");
  command->add_option("--max-distance", o->max_distance, "m; and no farther")
      ->check(CLI::PositiveNumber)
      ->needs("--poses");
  command->add_flag("--json", o->json, "Machine-readable output");
  command->footer("Example: evit map compare desk.pcd desk/map.pcd");
  command->callback([o] {
    const PointMap points = LoadPoints(o->map), reference = LoadPoints(o->reference);
    const std::optional<mapping::PathDistance> path = PathOf(o->poses);
    const mapping::PathDistance* const given = path ? &*path : nullptr;
    // To the nearest of all points of the other map, of those in range.
    const PointMap judged = InRange(points, given, o->min_distance, o->max_distance, o->map),
                   expected = InRange(reference, given, o->min_distance, o->max_distance, o->reference);
    const mapping::MapDistance exact = mapping::DistanceBetween(judged, reference, given, o->limit),
                               complete = mapping::DistanceBetween(expected, points, nullptr, o->limit);
    std::printf("%s", mapping::CompareText(o->map, exact, o->reference, complete, o->limit, o->json).c_str());
  });
}

}  // namespace evit::commands
