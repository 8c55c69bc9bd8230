#include <memory>

#include "common/config/rig_file.h"
#include "tools/evit/import_options.h"
#include "tools/formats/bag/bag_import.h"

namespace evit::commands {

void AddImportBag(CLI::App* import) {
  struct Options {
    ImportOptions shared;
    formats::BagImport job;
    std::string rig;
  };
  auto o = std::make_shared<Options>();
  formats::BagImport& job = o->job;
  CLI::App* bag = import->add_subcommand("bag", "ROS 1 bags: dvs_msgs or prophesee_event_msgs, Imu, truth");
  bag->add_option("FILE", job.files, "Bags of one recording; several are merged by time")->required();
  bag->add_option("--rig", o->rig,
                  "Calibration; its T_marker_body turns the truth's body into the IMU's, e.g. for VECtor")
      ->required();
  o->shared.AddTo(bag);
  bag->add_option("--events-topic", job.events_topic, "EventArray to take (default: the only one)");
  bag->add_option("--imu-topic", job.imu_topic, "sensor_msgs/Imu to take (default: the only one)");
  bag->add_option(
      "--truth-topic", job.truth_topic,
      "PoseStamped, TransformStamped, PoseWithCovarianceStamped or Odometry to take as truth (default: the "
      "only one of the first of these types that there is)");
  bag->footer(
      "Example: evit import bag events.bag imu.bag --rig rig.textproto --out sequence.lcmlog\n"
      "Times are those in the messages. Events, samples and poses that are out of order, not finite or\n"
      "outside the sensor are counted and left out.");
  bag->callback([o] {
    o->shared.Apply(&o->job);
    o->job.rig = LoadRig(o->rig);
    RunImport(o->job.files.front(), o->job, "PoseStamped, TransformStamped, Odometry",
              [&](const auto& progress) { return formats::ImportBag(o->job, progress); });
  });
}

}  // namespace evit::commands
