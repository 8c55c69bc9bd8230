
#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/geometry/pose_text.h"
#include "common/localization/prior_text.h"
#include "services/window_optimizer/photometric_optimizer.h"
#include "services/window_optimizer/window_optimizer.h"

namespace {

evit::PhotometricTrackerOptions PhotometricPart(const evit::PipelineOptions& o) {
  return {o.photometric,        o.keyframes.min_events, o.surface.lag_px,       o.points.min_depth_m,
          o.points.max_depth_m, o.window.map_sigma_m,   o.window.stamp_sigma_us};
}

int Main(int argc, char** argv) {
  evit::CommandLine line{"Tracks the body's 6-DoF pose in a known map from keyframes and IMU (LCM service)."};
  std::string rig, config, pose, checkpoint;
  evit::ServiceOptions options;
  line.Add("--rig", &rig, "Calibration of camera and IMU (text protobuf)").Required();
  line.Add("--config", &config, "Tracker settings (text protobuf; default: EVIT's, see evit config show)");
  line.Add(
      "--initial-pose", &pose,
      "Body in the map at the first keyframe: \"x y z qx qy qz qw\"; without it the place is looked for");
  std::string near, height, yaw;
  line.Add("--near", &near, "Where the place is looked for: \"x y z radius\", m (default: in the whole map)");
  line.Add("--height", &height, "At which heights of the body: \"low:high\", m");
  line.Add("--yaw", &yaw, "With which heading of the body's x axis: \"degrees:tolerance\"");
  line.Add("--checkpoint", &checkpoint,
           "File with the newest state, to continue from after a restart (real time; delete it to start "
           "from the initial pose)");
  evit::AddServiceOptions(&line, &options);
  if (const auto code = line.Parse(argc, argv)) return *code;
  const evit::Rig calibration = evit::LoadRig(rig);
  const evit::PipelineOptions pipeline = evit::LoadOptionsFor(calibration.camera, config);
  const bool evit = pipeline.method == evit::PipelineOptions::Method::kEvit;
  if (pose.empty() && !evit) return line.Missing("--initial-pose, which methods EVT and EVPT need,");
  evit::WindowOptimizer::Settings settings{calibration, TrackerPart(pipeline), evit::SE3(), options.lossless,
                                           checkpoint,  std::nullopt};
  if (!pose.empty()) settings.T_map_body = evit::ParsePose("--initial-pose", pose);
  if (evit) {
    settings.locate.emplace();
    settings.locate->search.prior = evit::ParsePlacePrior(near, height, yaw);
    settings.locate->from_nothing = pose.empty();
  }
  const auto bus = evit::OpenServiceBus(options);
  if (pipeline.method == evit::PipelineOptions::Method::kEvpt) {
    evit::PhotometricOptimizer service(
        bus.get(), evit::Channels(options.prefix),
        {settings.rig, PhotometricPart(pipeline), settings.T_map_body, options.lossless});
    return evit::RunService(&service, bus.get());
  }
  evit::WindowOptimizer service(bus.get(), evit::Channels(options.prefix), settings);
  return evit::RunService(&service, bus.get());
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("window_optimizer", Main, argc, argv); }
