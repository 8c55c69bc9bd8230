#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "tools/formats/frames/frame_source.h"

namespace evit::mapping {

/// A picture of a source and where it was taken from.
struct Frame {
  std::size_t index = 0;  // in the source
  Utime t = 0;            // its stamp, or its pose's
  SE3 T_map_camera;
};

struct FrameList {
  std::vector<Frame> frames;      // in the order of the source, or of stamps
  std::size_t without_pose = 0;   // left out: taken before, after or in a hole of the poses
  bool by_stamp = false;          // false: one pose for each picture, in the order of names
  bool stamps_ignored = false;    // there are stamps, but of another time than the poses
  Utime pose_interval = 0;        // us, from one pose to the next (median)
  std::size_t between_poses = 0;  // pictures whose poses are interpolated
};

/// The pictures of a source (OpenFrames(path)) with their poses. Where their stamps lie in the time of the
/// poses (whole numbers in s, ms, us or ns, whichever fits), poses are interpolated, over no more than 0.2 s.
/// Else there must be one pose for each picture. `poses`: T_map_camera. Throws std::runtime_error naming the
/// path, what is wrong and the remedy.
FrameList ListFrames(const formats::FrameSource& source, const std::string& path, const Trajectory& poses,
                     const std::string& poses_path);

/// The stamps of all pictures in the unit by which most lie within `begin` to `end`. Nothing where some have
/// none.
std::optional<std::vector<Utime>> StampsOf(const formats::FrameSource& source, Utime begin, Utime end);

/// A and B of "A:B", A < B. Throws std::runtime_error where that is not what the text says.
std::pair<std::size_t, std::size_t> ParseRange(const std::string& range);
/// Leaves frames A to B-1; throws where there are none.
void TakeRange(const std::string& range, FrameList* list);

}  // namespace evit::mapping
