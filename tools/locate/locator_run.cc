#include "tools/locate/locator_run.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "common/events/keyframe_builder.h"
#include "common/localization/place_index_file.h"
#include "common/map/denoise.h"
#include "common/map/map_file.h"
#include "common/tracking/feedback.h"
#include "tools/terminal/progress_bar.h"

namespace evit::locate {
namespace {

constexpr Utime kPiece = 10'000;  // us of events at a time

// A tracker, and all that it asks, answered at once.
class Session {
 public:
  Session(const PreparedMap& map, const Rig& rig, const PipelineOptions& options,
          const LocatingTracker::Options& locating, const PlaceFinderOptions& finder)
      : map_(map),
        tracker_(MakeTracker(rig, TrackerPart(options), SE3()), rig, TrackerPart(options), locating),
        finder_(*map.map, *map.places, rig, options.points, options.window, finder) {
    AnswerPoints();
  }

  TrackerOutput Process(const KeyframeInput& keyframe, LocatorResult* result) {
    TrackerOutput output = tracker_.Process(keyframe);
    AnswerPoints();
    while (const PlaceQuery* question = tracker_.PlaceQuestion()) {
      const auto begin = std::chrono::steady_clock::now();
      const std::vector<PlaceCandidate> answer = finder_.Answer(*question);
      if (question->everywhere) {
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        result->search_s = (result->search_s * result->searches + took.count()) / (result->searches + 1);
        ++result->searches;
        if (result->candidates.empty() && !answer.empty())
          result->candidates = answer, result->surface = question->surface;
      }
      PlaceSearch search{question->t, question->everywhere, question->up_body, answer, ""};
      tracker_.AddPlaces(answer);
      search.progress = tracker_.Progress();
      result->asked.push_back(std::move(search));
    }
    return output;
  }
  const LocatingTracker& tracker() const { return tracker_; }

 private:
  void AnswerPoints() {
    const VisibilityAnswer seen = map_.map->Query(tracker_.NextQuery());
    std::vector<Eigen::Vector3f> points;
    for (const std::int32_t id : seen.ids) points.push_back(map_.map->map().points[id]);
    tracker_.AddVisible(seen.ids, points);
  }

  const PreparedMap& map_;
  LocatingTracker tracker_;
  PlaceFinder finder_;
};

}  // namespace

PreparedMap PrepareMap(const std::string& path, int threads) {
  LoadedMap loaded = LoadMap(path);
  const MapSummary summary = Summarize(loaded.map);
  RequireMetres(summary, path);
  // As map_server does: they share the index.
  Denoise(DenoiseSettingsFor(loaded.map, summary.median_spacing), &loaded.map);
  PreparedMap prepared;
  PlaceIndexOptions options;
  options.threads = threads;
  {
    terminal::ProgressBar bar("preparing");
    prepared.places = std::make_unique<PlaceIndex>(ReadOrMakePlaceIndex(
        PlaceIndexPaths(path), loaded.map, options, [&](double share) { bar.Show(share, path); }));
    bar.Show(1, path);
  }
  prepared.map = std::make_unique<MapIndex>(std::move(loaded.map));
  return prepared;
}

LocatorResult RunLocator(const RecordedStreams& streams, const PreparedMap& map, const Rig& rig,
                         const PipelineOptions& options, const LocatingTracker::Options& locating,
                         const PlaceFinderOptions& finder, Utime begin, double seconds, double hold_s) {
  const std::clock_t started = std::clock();
  Utime end = std::min(streams.end(), begin + static_cast<Utime>(seconds * 1e6));
  LocatorResult result;
  result.begin = begin;
  std::size_t n_events = 0;
  Utime played = 0;
  Session session(map, rig, options, locating, finder);
  KeyframeBuilder builder(rig, {options.keyframes, options.surface, Keyframe::Encoding::kTimeSurface}, true);
  auto sample = std::lower_bound(streams.imu().begin(), streams.imu().end(), begin,
                                 [](const ImuSample& s, Utime t) { return s.t < t; });
  for (Utime t = begin; t < end && result.withdrawn.empty(); t += kPiece) {
    const Utime from = t - rig.camera_time_offset, to = from + kPiece;  // in the camera's clock
    const EventArray events = streams.Events(from, to);
    n_events += events.size();
    played += kPiece;
    builder.AddEvents(events, events.size() == 0 ? to : std::max(to, events.t.back()));
    for (; sample != streams.imu().end() && sample->t <= t + kPiece; ++sample) builder.AddImu(*sample);
    while (const auto keyframe = builder.Next()) {
      const TrackerOutput output = session.Process(InputOf(*keyframe), &result);
      builder.SetFeedbackFor(keyframe->seq, FeedbackOf(output));
      const bool tracking = output.mode == TrackerMode::kTracking;
      if (result.found) {
        result.held_s = ToSeconds(keyframe->utime - result.t);
        if (!tracking) result.withdrawn = output.reason;
        if (!tracking) break;
        continue;
      }
      result.progress = output.reason;
      result.t = keyframe->utime;
      result.after_s = ToSeconds(result.t - begin);
      result.T_map_body = session.tracker().state().T_map_body;
      result.found = tracking;
      if (tracking) end = std::min(streams.end(), result.t + static_cast<Utime>(hold_s * 1e6));
    }
  }
  result.cut = !result.found && streams.end() < begin + static_cast<Utime>(seconds * 1e6);
  if (played > 0) result.events_per_s = static_cast<double>(n_events) / ToSeconds(played);
  result.cpu_s = static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC;
  return result;
}

}  // namespace evit::locate
