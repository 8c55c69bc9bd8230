#include <CLI/CLI.hpp>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/geometry/pose_text.h"
#include "services/window_optimizer/photometric_optimizer.h"
#include "services/window_optimizer/window_optimizer.h"

namespace {

evit::TrackerOptions TrackerPart(const evit::PipelineOptions& o) {
  return {o.points,
          o.window,
          o.bootstrap,
          o.failure,
          o.keyframes.min_events,
          o.surface.lag_px,
          o.method == evit::PipelineOptions::Method::kEvt};
}

evit::PhotometricTrackerOptions PhotometricPart(const evit::PipelineOptions& o) {
  return {o.photometric,        o.keyframes.min_events, o.surface.lag_px,       o.points.min_depth_m,
          o.points.max_depth_m, o.window.map_sigma_m,   o.window.stamp_sigma_us};
}

int Main(int argc, char** argv) {
  CLI::App app{"Tracks the body's 6-DoF pose in a known map from keyframes and IMU (LCM service)."};
  std::string rig, config, pose, checkpoint;
  evit::ServiceOptions options;
  app.add_option("--rig", rig, "Calibration of camera and IMU (text protobuf)")->required();
  app.add_option("--config", config,
                 "Tracker settings (text protobuf; default: EVIT's, see evit config show)");
  app.add_option("--initial-pose", pose, "Body in the map at the first keyframe: \"x y z qx qy qz qw\"")
      ->required();
  app.add_option(
      "--checkpoint", checkpoint,
      "File with the newest state, to continue from after a restart (real time; delete it to start "
      "from the initial pose)");
  evit::AddServiceOptions(&app, &options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  const evit::PipelineOptions pipeline = evit::LoadOptions(config);
  const evit::WindowOptimizer::Settings settings{evit::LoadRig(rig), TrackerPart(pipeline),
                                                 evit::ParsePose("--initial-pose", pose), options.lossless,
                                                 checkpoint};
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
