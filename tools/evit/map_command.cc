#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/map/map_file.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/mapping/map_edit.h"
#include "tools/pictures/top_view.h"

namespace evit::commands {
namespace {

// Median of what is known of the points; the map has attributes.
float MedianOf(const PointMap& map, float PointAttributes::*value) {
  std::vector<float> values;
  for (const PointAttributes& a : map.attributes) values.push_back(a.*value);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void PrintSummary(const std::string& path, const LoadedMap& loaded, bool json) {
  const MapSummary s = Summarize(loaded.map);
  if (json) {
    const auto list = [](const Eigen::Vector3f& v) { return nlohmann::json{v.x(), v.y(), v.z()}; };
    nlohmann::json summary{{"file", path},
                           {"format", loaded.format},
                           {"points", s.n_points},
                           {"dropped", loaded.n_dropped},
                           {"min_m", list(s.min)},
                           {"max_m", list(s.max)},
                           {"median_m", list(s.median)},
                           {"spacing_m", s.median_spacing}};
    if (!loaded.map.attributes.empty()) {
      summary["sigma_m"] = MedianOf(loaded.map, &PointAttributes::sigma);
      summary["views"] = MedianOf(loaded.map, &PointAttributes::views);
      summary["contrast"] = MedianOf(loaded.map, &PointAttributes::contrast);
    }
    std::printf("%s\n", summary.dump(2).c_str());
    return;
  }
  std::printf("%s (%s)\n  points   %zu (%zu not finite left out)\n", path.c_str(), loaded.format.c_str(),
              s.n_points, loaded.n_dropped);
  std::printf("  bounds   x %.2f .. %.2f   y %.2f .. %.2f   z %.2f .. %.2f m\n", s.min.x(), s.max.x(),
              s.min.y(), s.max.y(), s.min.z(), s.max.z());
  std::printf("  median   %.2f %.2f %.2f m\n  spacing  %.4f m (median distance to the nearest neighbour)\n",
              s.median.x(), s.median.y(), s.median.z(), s.median_spacing);
  if (loaded.map.attributes.empty()) return;
  std::printf("  known    direction, sigma %.4f m, %.0f views, contrast %.2f (medians)\n",
              MedianOf(loaded.map, &PointAttributes::sigma), MedianOf(loaded.map, &PointAttributes::views),
              MedianOf(loaded.map, &PointAttributes::contrast));
}

// From above, and from the side: along y, x to the right, z up.
void WriteViews(const std::string& folder, const PointMap& map) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": cannot be made: " + error.message());
  pictures::WriteTopView(folder + "/top.png", map);
  PointMap turned = map;
  for (Eigen::Vector3f& p : turned.points) p = {p.x(), p.z(), -p.y()};
  pictures::WriteTopView(folder + "/side.png", turned, "-y");
}

}  // namespace

void AddMapCommand(CLI::App* app) {
  struct Options {
    std::string in, out, transform, png, views;
    double scale = 1, voxel = 0;
    bool json = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* map = app->add_subcommand("map", "Inspect and convert semi-dense maps")->require_subcommand(1);

  CLI::App* convert =
      map->add_subcommand("import", "Convert a point cloud (PCD, PLY, text) to binary PCD, in metres, z up");
  convert->add_option("IN", o->in, "Point cloud to read")->required();
  convert->add_option("--out,OUT", o->out, "PCD to write")->required();
  convert->add_option("--scale", o->scale, "Multiply coordinates, e.g. 0.001 for millimetres")
      ->check(CLI::PositiveNumber);
  convert->add_option("--transform", o->transform,
                      "16 numbers, row-major 4x4: moves the points (after scaling)");
  convert->add_option("--voxel", o->voxel, "Keep one point per cell of this size, m")
      ->check(CLI::PositiveNumber);
  convert->footer("Example: evit map import scan_mm.ply --scale 0.001 --voxel 0.01 --out map.pcd");
  convert->callback([o] {
    RequireOutput("--out", o->out);
    RequireNotAnInput("--out", o->out, {o->in});
    const SE3 T = o->transform.empty() ? SE3() : ParseTransform("--transform", o->transform);
    LoadedMap loaded = LoadMap(o->in, {o->scale, T});
    if (o->voxel > 0) mapping::Thin(o->voxel, &loaded.map);
    RequireMetres(Summarize(loaded.map), o->in);
    WritePcd(o->out, loaded.map);
    loaded.format = "PCD binary";
    PrintSummary(o->out, loaded, false);
  });

  AddMapBuild(map);
  AddMapCheck(map);
  AddMapCompare(map);
  AddMapEdits(map);
  AddMapPhotometric(map);

  CLI::App* info = map->add_subcommand("info", "Points, bounds and spacing of a point cloud");
  info->add_option("FILE", o->in, "Point cloud to read")->required();
  info->add_flag("--json", o->json, "Machine-readable output");
  info->add_option("--png", o->png, "PNG to write: the map from above, coloured by height");
  info->add_option("--out", o->views, "Folder for top.png and side.png (x to the right, z up)");
  info->footer("Example: evit map info map.pcd --png map.png");
  info->callback([o] {
    RequireOutput("--png", o->png);
    RequireNotAnInput("--png", o->png, {o->in});
    RequireOutputFolder("--out", o->views);
    const LoadedMap loaded = LoadMap(o->in);
    if (!o->png.empty()) pictures::WriteTopView(o->png, loaded.map);
    if (!o->views.empty()) WriteViews(o->views, loaded.map);
    PrintSummary(o->in, loaded, o->json);
    RequireMetres(Summarize(loaded.map), o->in);
  });
}

}  // namespace evit::commands
