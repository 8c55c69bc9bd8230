#include "tools/mapping/map_compare.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/map/map_file.h"
#include "tools/evit/commands.h"

namespace evit::commands {
namespace {

PointMap LoadPoints(const std::string& path) {
  PointMap map = LoadMap(path).map;
  if (map.points.empty()) throw std::runtime_error(path + ": holds no points");
  return map;
}

}  // namespace

void AddMapCompare(CLI::App* map) {
  struct Options {
    std::string map, reference;
    double limit = 0.02;
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
  command->add_flag("--json", o->json, "Machine-readable output");
  command->footer("Example: evit map compare desk.pcd desk/map.pcd");
  command->callback([o] {
    const PointMap points = LoadPoints(o->map), reference = LoadPoints(o->reference);
    const mapping::MapDistance exact = mapping::DistanceBetween(points, reference, o->limit),
                               complete = mapping::DistanceBetween(reference, points, o->limit);
    std::printf("%s", mapping::CompareText(o->map, exact, o->reference, complete, o->limit, o->json).c_str());
  });
}

}  // namespace evit::commands
