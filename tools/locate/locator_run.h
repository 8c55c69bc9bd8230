#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/config/pipeline_options.h"
#include "common/geometry/rig.h"
#include "common/localization/locating_tracker.h"
#include "common/localization/place_finder.h"
#include "tools/locate/recorded_streams.h"

namespace evit::locate {

/// A map and what finding places in it takes, made once.
struct PreparedMap {
  std::unique_ptr<MapIndex> map;
  std::unique_ptr<PlaceIndex> places;
};
/// Thinned as map_server does it. Throws std::runtime_error: unreadable, or not in metres. Shows its
/// progress.
PreparedMap PrepareMap(const std::string& path, int threads);

/// One keyframe's question, and what was answered.
struct PlaceSearch {
  Utime t = 0;
  bool everywhere = true;   // else only what is followed
  Eigen::Vector3d up_body;  // unit, the vertical that it was made with
  std::vector<PlaceCandidate> candidates;
  std::string progress;  // what the tracker made of it
};

/// What came of one start without a pose.
struct LocatorResult {
  Utime begin = 0;     // us
  bool found = false;  // the tracker says TRACKING
  double after_s = 0;  // sensor time from the start to that, or to the end of the part
  Utime t = 0;         // us: of the pose
  SE3 T_map_body;
  bool cut = false;                        // not found, and the recording ended before the time was over
  double held_s = 0;                       // that it went on tracking, of those asked for
  std::string withdrawn;                   // why it stopped doing so; empty: it did not
  std::string progress;                    // what the tracker said last
  int searches = 0;                        // of the whole map
  double search_s = 0;                     // for one of them, wall clock
  double events_per_s = 0;                 // of the part that was played
  double cpu_s = 0;                        // in all, without preparing the map
  std::vector<PlaceCandidate> candidates;  // the first search's
  cv::Mat surface;                         // that it was about
  std::vector<PlaceSearch> asked;          // one after the other
};

/// Starts a tracker without a pose at `begin` (us) of a recording and lets it run until it tracks, at most
/// for `seconds`, and `hold_s` beyond: as the four services do, in one process and without a bus.
LocatorResult RunLocator(const RecordedStreams& streams, const PreparedMap& map, const Rig& rig,
                         const PipelineOptions& options, const LocatingTracker::Options& locating,
                         const PlaceFinderOptions& finder, Utime begin, double seconds, double hold_s);

}  // namespace evit::locate
