#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/config/rig_file.h"
#include "common/evaluation/trajectory.h"
#include "common/map/map_file.h"
#include "common/mapping/map_builder.h"
#include "tools/evit/commands.h"
#include "tools/mapping/build_report.h"
#include "tools/mapping/frame_reader.h"
#include "tools/mapping/rgbd_views.h"
#include "tools/terminal/progress_bar.h"

namespace evit::commands {
namespace {

struct MapBuildOptions {
  std::string images, rgbd, poses, camera, out, adjusted, range;
  bool keep_poses = false;
  mapping::FrameReaderOptions reader;
  MapBuilderOptions build;
};

mapping::ReadFrames ReadPictures(const MapBuildOptions& o, const Trajectory& poses) {
  const Camera camera = LoadCamera(o.camera);
  mapping::FrameList list = mapping::ListFrames(o.images, poses, o.poses);
  if (!o.range.empty()) mapping::TakeRange(o.range, &list);
  const std::size_t n = list.frames.size();
  terminal::ProgressBar bar("reading " + std::to_string(n) + " pictures");
  bar.Show(0);
  mapping::ReadFrames frames =
      mapping::ReadEdges(list, camera, o.reader, [&](double share) { bar.Show(share); });
  for (const std::string& note : mapping::NotesOn(list, frames))
    std::fprintf(stderr, "note: %s\n", note.c_str());
  return frames;
}

void WriteBuilt(const MapBuildOptions& o, const BuiltMap& built, const std::vector<Utime>& stamps) {
  const PointMap map = mapping::MapOf(built);
  const std::string doubt = mapping::DoubtOf(built);
  if (map.points.empty()) throw std::runtime_error("no edge was confirmed by enough views: " + doubt);
  WriteMap(o.out, map);
  if (!o.adjusted.empty()) WriteTum(o.adjusted, mapping::PosesOf(built, stamps));
  if (!doubt.empty()) std::fprintf(stderr, "warning: %s\n", doubt.c_str());
  std::printf("%s", mapping::SummaryOf(o.out, built).c_str());
}

void BuildFromImages(const MapBuildOptions& o) {
  const Trajectory poses = ReadTum(o.poses);
  mapping::ReadFrames frames = ReadPictures(o, poses);
  BuiltMap built;
  {
    terminal::ProgressBar bar("building");
    built = BuildMap(std::move(frames.views), o.build,
                     [&](double share, const std::string& what) { bar.Show(share, what); });
  }
  WriteBuilt(o, built, frames.stamps);
}

void BuildFromRgbd(const MapBuildOptions& o) {
  const auto [begin, end] =
      o.range.empty() ? std::make_pair(std::size_t{0}, std::size_t{1'000'000}) : mapping::ParseRange(o.range);
  mapping::RgbdEdges edges;
  {
    terminal::ProgressBar bar("reading " + o.rgbd);
    bar.Show(0);
    edges = mapping::ReadRgbd(o.rgbd, begin, end, o.reader, o.build.stereo.max_depth_m,
                              [&](double share) { bar.Show(share); });
  }
  for (const std::string& note : mapping::NotesOn({}, edges.frames))
    std::fprintf(stderr, "note: %s\n", note.c_str());
  BuiltMap built;
  {
    terminal::ProgressBar bar("building");
    built = BuildMapFromDepths(std::move(edges.frames.views), std::move(edges.depths), o.build,
                               [&](double share, const std::string& what) { bar.Show(share, what); });
  }
  WriteBuilt(o, built, edges.frames.stamps);
}

}  // namespace

void AddMapBuild(CLI::App* map) {
  auto o = std::make_shared<MapBuildOptions>();
  CLI::App* command =
      map->add_subcommand("build", "Make a semi-dense map from pictures taken from known places");
  command->option_defaults()->always_capture_default();
  CLI::Option* images =
      command->add_option("--images", o->images, "Folder of pictures (PNG, JPEG, ...); colour becomes grey");
  command
      ->add_option(
          "--rgbd", o->rgbd,
          "Instead: folder of images/, depth/ (16 bit, mm), poses.txt and K.txt, as for map photometric")
      ->excludes(images);
  command
      ->add_option(
          "--poses", o->poses,
          "TUM file: camera in the map frame (z up), one row for each picture in the order of names, "
          "or at any time where pictures have stamps")
      ->needs(images);
  command
      ->add_option("--camera", o->camera,
                   "Calibration of the camera that took them: a file with the `camera` block of a rig file")
      ->needs(images);
  command->add_option("--out", o->out, "Map to write: .pcd or .ply")
      ->required()
      ->check(mapping::CannotWriteMap);
  command->add_option("--frames", o->range,
                      "A:B, use only pictures A to B-1 of those that have a pose (or of --rgbd)");
  command->add_option("--max-frames", o->reader.max_frames, "Use every n-th picture where there are more")
      ->check(CLI::Range(3, 5000));
  CLI::Option* contrast =
      command
          ->add_option("--contrast", o->reader.edges.sure_contrast,
                       "Step of log intensity that an edge has somewhere; half of it will do along the edge; "
                       "with --rgbd 0.25 by default")
          ->check(CLI::Range(0.05, 2.0));
  command->add_option("--min-depth", o->build.stereo.min_depth_m, "Nearest edge, m")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-depth", o->build.stereo.max_depth_m, "Farthest edge, m")
      ->check(CLI::PositiveNumber);
  command->add_option("--voxel", o->build.thinning.voxel_m, "One point of an edge per so many metres")
      ->check(CLI::Range(0.001, 0.1));
  command->add_flag("--keep-poses", o->keep_poses,
                    "Take the poses as exact instead of fitting them to each other");
  command->add_option("--poses-out", o->adjusted, "TUM file to write: the poses as they were fitted");
  command->add_option("--threads", o->build.threads, "Threads; the map does not depend on it")
      ->check(CLI::Range(1, 256));
  command->footer(
      "Example: evit map build --images camera --poses camera_poses.tum --camera camera.textproto --out "
      "map.pcd\n"
      "Depth comes from motion: the camera has to move sideways, some centimetres for each metre of "
      "distance.");
  command->callback([o, contrast] {
    // Where depth is measured a weak edge is placed as well as a strong one.
    if (!o->rgbd.empty() && contrast->count() == 0) o->reader.edges.sure_contrast = 0.25;
    if (!(o->build.stereo.min_depth_m < o->build.stereo.max_depth_m))
      throw std::runtime_error("--min-depth is not below --max-depth");
    o->reader.threads = o->build.threads;
    o->reader.edges.min_contrast = o->reader.edges.sure_contrast / 2;
    o->build.adjustment.move_poses = !o->keep_poses;
    if (!o->rgbd.empty()) return BuildFromRgbd(*o);
    if (o->images.empty() || o->poses.empty() || o->camera.empty())
      throw std::runtime_error("expected --images, --poses and --camera, or --rgbd");
    BuildFromImages(*o);
  });
}

}  // namespace evit::commands
