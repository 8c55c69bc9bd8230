#include <memory>
#include <tuple>

#include "common/geometry/pose_text.h"
#include "tools/evit/import_options.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/formats/rpg/rpg_import.h"

namespace evit::commands {

void AddImportRpg(CLI::App* import) {
  struct Options {
    ImportOptions shared;
    formats::RpgImport job;
    std::string size, pose;
  };
  auto o = std::make_shared<Options>();
  formats::RpgImport& job = o->job;
  CLI::App* rpg = import->add_subcommand("rpg", "A folder in the text format of RPG's event camera dataset");
  rpg->add_option("DIR", job.folder,
                  "Folder with events.txt, imu.txt, groundtruth.txt (if known), calib.txt (for --rig-out)")
      ->required();
  o->shared.AddTo(rpg);
  rpg->add_option("--size", o->size, "WxH of the sensor in pixels (default: 240x180, DAVIS240)");
  rpg->add_option("--t-body-camera", o->pose,
                  "Camera in the body (IMU) frame: \"x y z qx qy qz qw\" (default: one frame)");
  rpg->add_flag("--truth-of-body", job.truth_of_body,
                "groundtruth.txt holds poses of the body (IMU); without this flag, of the camera");
  auto* rig = rpg->add_option("--rig-out", job.rig_out, "Rig file to write, from calib.txt and what follows");
  ImuNoise& noise = job.imu_noise;
  for (const auto& [name, value, text] :
       {std::tuple("--gyro-noise", &noise.gyro_density, "Gyro noise density, rad/s/sqrt(Hz)"),
        std::tuple("--accel-noise", &noise.accel_density, "Accelerometer noise density, m/s^2/sqrt(Hz)"),
        std::tuple("--gyro-walk", &noise.gyro_random_walk, "Gyro bias random walk, rad/s^2/sqrt(Hz)"),
        std::tuple("--accel-walk", &noise.accel_random_walk,
                   "Accelerometer bias random walk, m/s^3/sqrt(Hz)")}) {
    rpg->add_option(name, *value, text)->capture_default_str()->check(CLI::PositiveNumber)->needs(rig);
  }
  rpg->footer(
      "Example: evit import rpg shapes_6dof --rig-out rig.textproto --out shapes.lcmlog\n"
      "Noise: the defaults are the MPU6150's, in the DAVIS240C. Events, samples and poses that are out of\n"
      "order, not finite or outside the sensor are counted and left out.");
  rpg->callback([o] {
    RequireOutput("--rig-out", o->job.rig_out);
    o->shared.Apply(&o->job);
    if (!o->size.empty()) ParseSize(o->size, &o->job.width, &o->job.height);
    if (!o->pose.empty()) o->job.T_body_camera = ParsePose("--t-body-camera", o->pose);
    RunImport(o->job.folder, o->job, "groundtruth.txt",
              [&](const auto& progress) { return formats::ImportRpg(o->job, progress); });
  });
}

}  // namespace evit::commands
