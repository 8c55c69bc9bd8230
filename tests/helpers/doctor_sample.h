#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"
#include "common/map/point_map.h"

namespace evit::doctor {

/// A recording with its rig, map and truth, all of which a fault can change.
struct Sample {
  EventArray events;
  std::vector<ImuSample> imu;
  Trajectory truth;
  PointMap map;
  Rig rig;
  std::optional<SE3> start{};  // T_map_body, as a user gives it; none: the truth's
};

/// Of four files; the first `seconds` of the log.
Sample LoadSample(const std::string& log, const std::string& rig, const std::string& map,
                  const std::string& truth, double seconds = 60);

/// What the doctor says of it; without a map where that has no points.
diagnosis::Findings ExamineSample(const Sample& sample);

/// The events, IMU samples and poses of [begin, end] s after the first event.
Sample Piece(const Sample& sample, double begin, double end);
/// The events of the indices that are to be kept.
void KeepEvents(Sample* sample, const std::function<bool(std::size_t)>& keep);
/// By their stamps; equal ones stay as they are.
void SortEvents(EventArray* events);
/// Noise: `n` events at any time and pixel.
void AddUniformEvents(Sample* sample, std::size_t n, std::mt19937* random);
/// Every `n`th event left out.
Sample Thinned(const Sample& sample, int n);

}  // namespace evit::doctor
