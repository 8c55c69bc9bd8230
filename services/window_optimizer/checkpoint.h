#pragma once

#include <optional>
#include <string>

#include "common/service/mapped_file.h"
#include "common/tracking/prior.h"

namespace evit {

/// What a restarted optimiser needs to continue: the newest keyframe and what was known at it.
struct Checkpoint {
  Utime t = 0;                                         // us: of the keyframe
  std::int64_t keyframe_epoch = 0, keyframe_seq = -1;  // which one it was
  BodyState state;
  Matrix15d information = Matrix15d::Zero();       // of that state; zero while bootstrapping
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  // rad/s, body frame
  double image_speed = 0;                          // pixels/s, see tracker_mode_t

  /// False if saved while bootstrapping.
  bool tracking() const { return !information.isZero(0); }
  /// The state `dt` us later at constant velocity and rate.
  BodyState After(Utime dt) const;
};

/// Keeps the newest checkpoint in a file.
class CheckpointFile {
 public:
  /// Throws std::runtime_error where the file cannot be written.
  explicit CheckpointFile(const std::string& path) : file_(path, 1) {}

  void Store(const Checkpoint& checkpoint);
  /// None where there is none, or what is there makes no sense.
  std::optional<Checkpoint> Load() const;

 private:
  struct Record {
    std::int64_t t, keyframe_epoch, keyframe_seq;
    double state[16], rate[3], image_speed, information[15 * 15];
  };
  MappedRecord<Record> file_;
};

}  // namespace evit
