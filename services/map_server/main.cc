#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/map/map_file.h"
#include "services/map_server/map_server.h"

namespace {

int Main(int argc, char** argv) {
  CLI::App app{"Serves the points of a semi-dense map that a camera sees (LCM service)."};
  std::string path;
  evit::ServiceOptions options;
  app.add_option("--map", path, "Point cloud: PCD, PLY or text, metres, z up")->required();
  evit::AddServiceOptions(&app, &options, false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  evit::LoadedMap loaded = evit::LoadMap(path);
  const evit::MapSummary summary = evit::Summarize(loaded.map);
  evit::RequireMetres(summary, path);
  char text[200];
  std::snprintf(text, sizeof text, "%zu points (%s), %.1f x %.1f x %.1f m, spacing %.3f m", summary.n_points,
                loaded.format.c_str(), summary.max.x() - summary.min.x(), summary.max.y() - summary.min.y(),
                summary.max.z() - summary.min.z(), summary.median_spacing);
  const auto bus = evit::OpenServiceBus(options);
  evit::MapServer service(bus.get(), evit::Channels(options.prefix), evit::MapIndex(std::move(loaded.map)),
                          text);
  return evit::RunService(&service, bus.get());
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("map_server", Main, argc, argv); }
