#include <cstdio>
#include <optional>
#include <stdexcept>

#include "common/localization/place_index_file.h"
#include "common/map/denoise.h"
#include "common/map/map_file.h"
#include "services/map_server/map_server.h"

namespace {

std::string Describe(const evit::LoadedMap& loaded, const evit::MapSummary& summary,
                     const evit::DenoiseSettings& denoise, const evit::DenoiseSummary& denoised) {
  char text[240];
  std::snprintf(text, sizeof text, "%zu points (%s), %.1f x %.1f x %.1f m, spacing %.4f m; ",
                summary.n_points, loaded.format.c_str(), summary.max.x() - summary.min.x(),
                summary.max.y() - summary.min.y(), summary.max.z() - summary.min.z(), summary.median_spacing);
  std::string description = text;
  if (denoise.radius <= 0) return description + "as read";
  std::snprintf(text, sizeof text, "thinned within %.4f m: %zu moved, %zu left out", denoise.radius,
                denoised.n_moved, denoised.n_dropped);
  return description + text;
}

int Main(int argc, char** argv) {
  evit::CommandLine line{
      "Serves what a camera sees of a map: points of a semi-dense one, views of a photometric one "
      "(LCM service)."};
  std::string path, photometric_path;
  evit::ServiceOptions options;
  line.Add("--map", &path, "Point cloud: PCD, PLY or text, metres, z up");
  line.Add("--photometric-map", &photometric_path, "PLY with intensities (evit map photometric), for EVPT");
  double radius = -1;
  line.Add("--denoise-radius", &radius,
           "Points move onto the line through their neighbours within this, m; 0: as read. Left out: "
           "2.5 times the points' spacing (0.01 to 0.025), and as read where the map has sigmas (evit map "
           "build thins its maps itself)")
      .Range(0.0, 0.2);
  bool places = false;
  line.AddFlag(
      "--places", &places,
      "Make ready to say where in the map a keyframe was seen now, and not at the first question; kept "
      "beside the map, as MAP.places (about 25 MB; may be deleted), or in the user's cache folder where the "
      "map's cannot be written");
  evit::AddServiceOptions(&line, &options, false);
  if (const auto code = line.Parse(argc, argv)) return *code;
  if (path.empty() && photometric_path.empty()) return line.Missing("--map or --photometric-map");
  evit::LoadedMap loaded;
  std::string description;
  if (!path.empty()) {
    loaded = evit::LoadMap(path);
    const evit::MapSummary summary = evit::Summarize(loaded.map);
    evit::RequireMetres(summary, path);
    evit::DenoiseSettings denoise = evit::DenoiseSettingsFor(loaded.map, summary.median_spacing);
    if (radius >= 0) denoise.radius = radius;
    description = Describe(loaded, summary, denoise, evit::Denoise(denoise, &loaded.map));
  }
  std::optional<evit::PhotometricMap> photometric;
  if (!photometric_path.empty()) {
    photometric = evit::LoadPhotometricMap(photometric_path);
    description += (description.empty() ? "" : "; ") + std::to_string(photometric->points.size()) +
                   " photometric points";
  }
  const auto bus = evit::OpenServiceBus(options);
  evit::MapServer service(bus.get(), evit::Channels(options.prefix), evit::MapIndex(std::move(loaded.map)),
                          description);
  if (photometric) service.ServeViews(*photometric);
  if (!path.empty()) service.KeepPlacesIn(evit::PlaceIndexPaths(path));
  if (places) service.PreparePlaces();
  photometric.reset();
  return evit::RunService(&service, bus.get());
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("map_server", Main, argc, argv); }
