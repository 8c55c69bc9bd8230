#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"
#include "common/map/point_map.h"
#include "tools/doctor/doctor.h"

namespace evit::doctor {

/// A recording with its rig, map and truth, all of which a fault can change.
struct Sample {
  EventArray events;
  std::vector<ImuSample> imu;
  Trajectory truth;
  PointMap map;
  Rig rig;
};

/// Of four files; the first `seconds` of the log.
Sample LoadSample(const std::string& log, const std::string& rig, const std::string& map,
                  const std::string& truth, double seconds = 60);

/// What the doctor says of it.
diagnosis::Findings ExamineSample(const Sample& sample);

/// The events, IMU samples and poses of [begin, end] s after the first event.
Sample Piece(const Sample& sample, double begin, double end);
/// Every `n`th event left out.
Sample Thinned(const Sample& sample, int n);

struct Fault {
  std::string name;
  std::string check;  // what has to be named first or second
  std::function<void(Sample*)> make;
  std::function<bool(const Sample&)> applies{};  // where it is one, and can show; empty: everywhere
};
const std::vector<Fault>& Faults();

/// Whether the doctor names the fault first or second; `said`: what it says of a sick sample, a line each.
bool IsNamed(const Fault& fault, const diagnosis::Findings& findings, std::string* said);

}  // namespace evit::doctor
