#pragma once

#include <optional>
#include <string>
#include <utility>

#include "common/mapping/map_builder.h"
#include "tools/mapping/event_views.h"
#include "tools/mapping/frame_reader.h"

namespace evit::mapping {

/// What poses tell of.
enum class PosedFrame { kCamera, kBody, kMarker };

/// What a map is made from, one of three, and how.
struct MapMaking {
  std::string images;  // folder of pictures: needs poses and camera
  std::string rgbd;    // folder of RGB-D images with all they need
  std::string events;  // LCM log: needs poses and rig
  std::string poses, camera, rig;
  std::optional<PosedFrame> poses_of;                // nothing: the camera with images, the body with events
  SE3 T_map_world;                                   // poses are in the world's frame
  std::string frames;                                // "A:B" of pictures, empty: all
  std::optional<std::pair<double, double>> seconds;  // of events, from the first pose; nothing: all
  FrameReaderOptions reader;
  EventReaderOptions event_reader;
  MapBuilderOptions build;
};

struct MadeMap {
  BuiltMap built;
  std::vector<Utime> stamps;  // of its views
};

/// Makes it, with progress bars and notes on stderr. Throws std::runtime_error naming file, what is wrong and
/// the remedy.
MadeMap MakeMap(const MapMaking& making);

}  // namespace evit::mapping
