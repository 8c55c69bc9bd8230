#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/map/denoise.h"
#include "common/map/map_file.h"
#include "services/map_server/map_server.h"

namespace {

int Main(int argc, char** argv) {
  CLI::App app{"Serves the points of a semi-dense map that a camera sees (LCM service)."};
  std::string path;
  evit::DenoiseSettings denoise;
  evit::ServiceOptions options;
  app.add_option("--map", path, "Point cloud: PCD, PLY or text, metres, z up")->required();
  app.add_option("--denoise-radius", denoise.radius,
                 "Points move onto the line through their neighbours within this, m; 0: as read")
      ->check(CLI::Range(0.0, 0.2))
      ->capture_default_str();
  evit::AddServiceOptions(&app, &options, false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  evit::LoadedMap loaded = evit::LoadMap(path);
  const evit::MapSummary summary = evit::Summarize(loaded.map);
  evit::RequireMetres(summary, path);
  const evit::DenoiseSummary denoised = evit::Denoise(denoise, &loaded.map);
  char text[240];
  std::snprintf(text, sizeof text,
                "%zu points (%s), %.1f x %.1f x %.1f m, spacing %.3f m; denoised: %zu moved, %zu left out",
                summary.n_points, loaded.format.c_str(), summary.max.x() - summary.min.x(),
                summary.max.y() - summary.min.y(), summary.max.z() - summary.min.z(), summary.median_spacing,
                denoised.n_moved, denoised.n_dropped);
  const auto bus = evit::OpenServiceBus(options);
  evit::MapServer service(bus.get(), evit::Channels(options.prefix), evit::MapIndex(std::move(loaded.map)),
                          text);
  return evit::RunService(&service, bus.get());
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("map_server", Main, argc, argv); }
