#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/map/map_file.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/mapping/build_report.h"
#include "tools/mapping/map_making.h"

namespace evit::commands {
namespace {

struct MapBuildOptions {
  mapping::MapMaking making;
  std::string out, adjusted, seconds, poses_of, T_map_world;
  bool keep_poses = false;
};

void MakeAndWrite(const MapBuildOptions& o) {
  const mapping::MadeMap made = mapping::MakeMap(o.making);
  const PointMap map = mapping::MapOf(made.built);
  const std::string doubt = mapping::DoubtOf(made.built);
  if (map.points.empty()) throw std::runtime_error("no edge was confirmed by enough views: " + doubt);
  WriteMap(o.out, map);
  if (!o.adjusted.empty()) WriteTum(o.adjusted, mapping::PosesOf(made.built, made.stamps));
  if (!doubt.empty()) std::fprintf(stderr, "warning: %s\n", doubt.c_str());
  std::printf("%s", mapping::SummaryOf(o.out, made.built).c_str());
}

void AddSources(CLI::App* command, MapBuildOptions* o) {
  mapping::MapMaking& m = o->making;
  CLI::Option* images =
      command
          ->add_option(
              "--images", m.images,
              "Pictures of a camera: a folder or zip archive (PNG, JPEG, ...), or a bag of ROS 1 or 2; "
              "named again: of a second camera on the same body")
          ->expected(1)
          ->take_all();
  command
      ->add_option("--topic", m.topics, "Images of a bag, for each --images (default: the only ones it has)")
      ->needs(images)
      ->expected(1)
      ->take_all();
  CLI::Option* depth = command->add_option(
      "--depth", m.depth.images,
      "Depth images (16 bit) that go with --images, by stamps: folder, zip archive or bag; edges are then at "
      "the depth measured");
  depth->needs(images);
  command
      ->add_option(
          "--depth-camera", m.depth.camera,
          "Calibration of the depth camera, with T_body_camera as the file of --camera (default: depth "
          "images are registered to the pictures)")
      ->needs(depth);
  command->add_option("--depth-topic", m.depth.topic, "Depth images of a bag")->needs(depth);
  command
      ->add_option("--depth-scale", m.depth.units_per_metre,
                   "Units of depth per metre (default: 1000, with TUM's layout 5000)")
      ->check(CLI::PositiveNumber)
      ->default_str("");
  CLI::Option* rgbd = command->add_option("--rgbd", m.rgbd,
                                          "Instead: folder of images/, depth/ (16 bit, mm), poses.txt and "
                                          "K.txt, as for map photometric; or of TUM's "
                                          "layout (rgb.txt, depth.txt, groundtruth.txt)");
  CLI::Option* events =
      command->add_option("--events", m.events, "Instead: LCM log with EVENTS (evit import)");
  images->excludes(rgbd)->excludes(events);
  rgbd->excludes(events);
  command->add_option(
      "--poses", m.poses,
      "TUM file, with --images one row for each picture in the order of names, or at any time where pictures "
      "have stamps: then poses are interpolated, over 0.2 s at most");
  command
      ->add_option("--poses-of", o->poses_of,
                   "What the poses are of (default: camera with --images, body with --events, as "
                   "LOG.truth.tum); body or marker need T_body_camera, and T_marker_body, in the file of "
                   "--camera")
      ->check(CLI::IsMember({"camera", "body", "marker"}));
  command->add_option("--T-map-world", o->T_map_world,
                      "16 numbers, row-major 4x4: brings poses into the map frame (z up); as for import "
                      "(default: they are in it)");
  command
      ->add_option("--camera", m.cameras,
                   "Calibration of the camera that took the pictures, for each --images: a file with the "
                   "`camera` block "
                   "of a rig file; of two cameras with T_body_camera")
      ->expected(1)
      ->take_all();
  command->add_option("--rig", m.rig, "Rig file of the event camera")->needs(events);
  command->add_option("--frames", m.frames,
                      "A:B, use only pictures A to B-1 of those that have a pose (or of --rgbd)");
  command->add_option("--seconds", o->seconds, "A:B in s from the first pose, use only these events")
      ->needs(events);
}

}  // namespace

void AddMapBuild(CLI::App* map) {
  auto o = std::make_shared<MapBuildOptions>();
  CLI::App* command = map->add_subcommand(
      "build", "Make a semi-dense map from pictures, RGB-D images or events with known poses");
  command->option_defaults()->always_capture_default();
  AddSources(command, o.get());
  command->add_option("--out", o->out, "Map to write: .pcd or .ply")
      ->required()
      ->check(mapping::CannotWriteMap);
  command
      ->add_option("--max-frames", o->making.reader.max_frames,
                   "Use every n-th picture, or short time of events, where there are more")
      ->check(CLI::Range(3, 5000));
  CLI::Option* contrast =
      command
          ->add_option("--contrast", o->making.reader.edges.sure_contrast,
                       "Step of log intensity that an edge has somewhere; half of it will do along the edge; "
                       "less is taken where pictures show few; with --rgbd 0.25 by default")
          ->check(CLI::Range(0.05, 2.0));
  command->add_option("--min-depth", o->making.build.stereo.min_depth_m, "Nearest edge, m")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-depth", o->making.build.stereo.max_depth_m, "Farthest edge, m")
      ->check(CLI::PositiveNumber);
  CLI::Option* voxel =
      command
          ->add_option(
              "--voxel", o->making.build.thinning.voxel_m,
              "One point per so many metres of an edge; with --images less by default where edges are "
              "nearer than 1.3 m")
          ->check(CLI::Range(0.001, 0.1));
  command->add_flag("--keep-poses", o->keep_poses,
                    "Take the poses as exact instead of fitting them to each other");
  command->add_option("--poses-out", o->adjusted, "TUM file to write: the poses as they were fitted");
  command->add_option("--threads", o->making.build.threads, "Threads; the map does not depend on it")
      ->check(CLI::Range(1, 256));
  command->footer(
      "Example: evit map build --images camera --poses camera_poses.tum --camera camera.textproto --out "
      "map.pcd\n"
      "         evit map build --images left_camera.zip --poses gt.txt --poses-of marker --camera "
      "left.textproto "
      "--out map.pcd\n"
      "         evit map build --events desk.lcmlog --poses desk.lcmlog.truth.tum --rig rig.textproto --out "
      "map.pcd\n"
      "Depth comes from motion: the camera has to move sideways, some centimetres for each metre of "
      "distance.");
  command->callback([o, contrast, voxel] {
    mapping::MapMaking& m = o->making;
    RequireOutput("--out", o->out);
    RequireOutput("--poses-out", o->adjusted);
    RequireNotAnInput("--poses-out", o->adjusted, {m.poses, m.events, m.rig, o->out});
    // Where depth is measured a weak edge is placed as well as a strong one.
    if (!m.rgbd.empty() && contrast->count() == 0) m.reader.edges.sure_contrast = 0.25;
    if (!(m.build.stereo.min_depth_m < m.build.stereo.max_depth_m))
      throw std::runtime_error("--min-depth is not below --max-depth");
    if (!o->seconds.empty()) m.seconds = ParseSeconds(o->seconds);
    if (o->poses_of == "camera") m.poses_of = mapping::PosedFrame::kCamera;
    if (o->poses_of == "body") m.poses_of = mapping::PosedFrame::kBody;
    if (o->poses_of == "marker") m.poses_of = mapping::PosedFrame::kMarker;
    if (!o->T_map_world.empty()) m.T_map_world = ParseTransform("--T-map-world", o->T_map_world);
    m.reader.find_contrast = contrast->count() == 0;
    if (voxel->count() > 0) m.build.thinning.finer_near = false;
    m.reader.threads = m.event_reader.threads = m.build.threads;
    m.event_reader.slices.most = m.reader.max_frames;
    m.reader.edges.min_contrast = m.reader.edges.sure_contrast / 2;
    m.build.adjustment.move_poses = !o->keep_poses;
    MakeAndWrite(*o);
  });
}

}  // namespace evit::commands
