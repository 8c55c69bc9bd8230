#include <stdexcept>
#include <string>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "services/frame_builder/frame_builder.h"

namespace {

int Main(int argc, char** argv) {
  evit::CommandLine line{
      "Makes keyframes (time surfaces with the IMU samples between them) from events and IMU (LCM service)."};
  std::string rig, config, imu = "auto";
  evit::ServiceOptions options;
  line.Add("--rig", &rig, "Calibration of camera and IMU (text protobuf)").Required();
  line.Add("--config", &config, "Tracker settings (text protobuf; default: EVIT's, see evit config show)");
  line.Add(
      "--imu", &imu,
      "Event-only tracking: yes: wait for the IMU; no: none comes; auto: none, where none comes within a "
      "second of events (default)");
  evit::AddServiceOptions(&line, &options);
  if (const auto code = line.Parse(argc, argv)) return *code;
  if (imu != "auto" && imu != "yes" && imu != "no")
    throw std::runtime_error("--imu " + imu + ": expected yes, no or auto");
  evit::FrameBuilder::Settings settings;
  settings.rig = evit::LoadRig(rig);
  const evit::PipelineOptions pipeline = evit::LoadOptionsFor(settings.rig.camera, config);
  settings.keyframes = {pipeline.keyframes, pipeline.surface,
                        pipeline.method == evit::PipelineOptions::Method::kEvpt
                            ? evit::Keyframe::Encoding::kEventCount
                            : evit::Keyframe::Encoding::kTimeSurface,
                        pipeline.method == evit::PipelineOptions::Method::kEvt && imu != "yes",
                        imu == "no" ? 0 : evit::EventClock::kPatience};
  settings.lossless = options.lossless;
  const auto bus = evit::OpenServiceBus(options);
  evit::FrameBuilder service(bus.get(), evit::Channels(options.prefix), settings);
  return evit::RunService(&service, bus.get());
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("frame_builder", Main, argc, argv); }
