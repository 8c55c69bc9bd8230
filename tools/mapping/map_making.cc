#include "tools/mapping/map_making.h"

#include <cmath>
#include <stdexcept>

#include "common/config/rig_file.h"
#include "tools/mapping/image_making.h"
#include "tools/terminal/progress_bar.h"

namespace evit::mapping {
namespace {

MadeMap Build(ReadFrames frames, const MapBuilderOptions& options) {
  terminal::ProgressBar bar("building");
  return {BuildMap(std::move(frames.views), options,
                   [&](double share, const std::string& what) { bar.Show(share, what); }),
          std::move(frames.stamps)};
}

Trajectory PartOf(const Trajectory& all, const std::optional<std::pair<double, double>>& seconds,
                  const std::string& path) {
  if (!seconds || all.empty()) return all;
  Trajectory part;
  for (const StampedPose& pose : all) {
    const double t = ToSeconds(pose.t - all.front().t);
    if (t >= seconds->first && t < seconds->second) part.push_back(pose);
  }
  if (part.empty()) throw std::runtime_error(path + ": holds no pose in the seconds asked for");
  return part;
}

MadeMap MakeFromEvents(const MapMaking& m) {
  if (m.poses.empty() || m.rig.empty()) throw std::runtime_error("--events needs --poses and --rig");
  const Rig rig = LoadRig(m.rig);
  const PosedFrame of = m.poses_of.value_or(PosedFrame::kBody);
  SE3 T_posed_body;
  if (of == PosedFrame::kMarker) T_posed_body = rig.T_marker_body;
  if (of == PosedFrame::kCamera) T_posed_body = rig.T_body_camera.Inverse();
  Trajectory body = PartOf(ReadTum(m.poses), m.seconds, m.poses);
  for (StampedPose& pose : body) pose.pose = m.T_map_world * pose.pose * T_posed_body;
  MapBuilderOptions options = OptionsForEvents(m.build);
  // How far things are says how events of a moment belong together; first by a guess, then as it was found.
  double depth = options.typical_depth_m > 0 ? options.typical_depth_m : kFirstDepth;
  ReadFrames frames;
  for (int round = 0; round < 2; ++round) {
    {
      terminal::ProgressBar bar("reading events");
      bar.Show(0);
      frames = ReadEventViews(m.events, body, m.poses, rig, depth, m.event_reader,
                              [&](double share) { bar.Show(share); });
    }
    if (m.build.typical_depth_m > 0) break;
    const double found = SceneDepth(frames.views, options);
    const bool near = std::abs(found - depth) < 0.2 * depth;
    options.typical_depth_m = found;
    if (found <= 0 || near) break;
    depth = found;
  }
  PrintNotes({}, frames);
  const double lag =
      options.typical_depth_m > 0 ? TakeOutLag(options.typical_depth_m, options, &frames.views) : 0;
  MadeMap made = Build(std::move(frames), options);
  made.built.event_lag_px = lag;
  made.built.tried = 0;  // a view of events shows but the edges across its motion: few find each other
  return made;
}

}  // namespace

MadeMap MakeMap(const MapMaking& making) {
  if (!making.rgbd.empty()) return MakeFromRgbd(making);
  if (!making.events.empty()) return MakeFromEvents(making);
  if (!making.images.empty()) return MakeFromImages(making);
  throw std::runtime_error("expected --images, --rgbd or --events");
}

}  // namespace evit::mapping
