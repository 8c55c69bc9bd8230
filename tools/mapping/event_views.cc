#include "tools/mapping/event_views.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

#include "common/events/hot_pixels.h"
#include "common/parallel/parallel_for.h"
#include "tools/calibration/recorded_events.h"

namespace evit::mapping {
namespace {

constexpr std::size_t kLeastEdges = 100;  // of a view that shows something

// Fills slices with events as they come and makes views of those that are full.
class SliceFiller {
 public:
  SliceFiller(const Rig& rig, double depth, const EventReaderOptions& options, std::vector<EventSlice> slices)
      : options_(options),
        depth_(depth),
        view_(rig.camera, options.view),
        hot_(rig.camera.width, rig.camera.height, options.hot_pixel_hz),
        is_hot_(static_cast<std::size_t>(rig.camera.width) * rig.camera.height, 0),
        width_(rig.camera.width),
        height_(rig.camera.height),
        slices_(std::move(slices)) {}

  void Add(const EventArray& packet) {
    EventArray events;  // inside the image
    for (std::size_t k = 0; k < packet.size(); ++k) {
      if (packet.x[k] < width_ && packet.y[k] < height_)
        events.push_back(packet.t[k], packet.x[k], packet.y[k], packet.p[k]);
    }
    MarkHotPixels(events);
    for (std::size_t k = 0; k < events.size() && next_ < slices_.size(); ++k) {
      while (next_ < slices_.size() && events.t[k] >= slices_[next_].end) ++next_;
      if (next_ == slices_.size() || events.t[k] < slices_[next_].begin) continue;
      if (is_hot_[static_cast<std::size_t>(events.y[k]) * width_ + events.x[k]] == 0)
        slices_[next_].events.push_back(events.t[k], events.x[k], events.y[k], events.p[k]);
    }
    if (next_ - made_ >= 32) MakeViews();
  }

  void MakeViews() {
    const std::size_t first = made_, n = next_ - made_;
    std::vector<PosedEdges> views(n, PosedEdges{{}, {}, EdgeImage(1, 1, {}, true)});
    ParallelFor(static_cast<int>(n), options_.threads,
                [&](int k) { views[k] = view_.Make(slices_[first + k], depth_); });
    for (std::size_t k = 0; k < n; ++k) {
      EventSlice& slice = slices_[first + k];
      slice.events = {};
      ++result_.read;
      if (views[k].edges.edges().size() < kLeastEdges) {
        ++result_.poor;
        continue;
      }
      result_.views.push_back(std::move(views[k]));
      result_.stamps.push_back((slice.begin + slice.end) / 2);
    }
    made_ = next_;
  }

  ReadFrames Finish() {
    next_ = slices_.size();
    MakeViews();
    return std::move(result_);
  }
  double share() const { return static_cast<double>(next_) / static_cast<double>(slices_.size()); }

 private:
  // A pixel that was hot once is not believed again.
  void MarkHotPixels(const EventArray& events) {
    hot_.Update(events, 0, events.size());
    for (const std::int32_t pixel : hot_.pixels()) is_hot_[pixel] = 1;
  }

  EventReaderOptions options_;
  double depth_;
  EventView view_;
  HotPixels hot_;
  std::vector<char> is_hot_;
  int width_, height_;
  std::vector<EventSlice> slices_;
  std::size_t next_ = 0, made_ = 0;  // slice that events go to; slices before it that are views
  ReadFrames result_;
};

std::string Span(Utime from, Utime to) {
  char text[80];
  std::snprintf(text, sizeof text, "%.3f to %.3f s", ToSeconds(from), ToSeconds(to));
  return text;
}

}  // namespace

ReadFrames ReadEventViews(const std::string& log, const Trajectory& body, const std::string& poses_path,
                          const Rig& rig, double depth, const EventReaderOptions& options,
                          const std::function<void(double)>& progress) {
  if (body.size() < 2) throw std::runtime_error(poses_path + ": holds fewer than two poses");
  std::vector<EventSlice> slices = PlanSlices(body, rig, depth, options.slices);
  if (slices.empty()) {
    throw std::runtime_error(poses_path +
                             ": by these poses the camera barely moves, or they have holes; an "
                             "event camera at rest shows no edges");
  }
  const Utime begin = slices.front().begin, end = slices.back().end;
  SliceFiller filler(rig, depth, options, std::move(slices));
  Utime first = std::numeric_limits<Utime>::max(), last = std::numeric_limits<Utime>::min();
  calibration::ForEachEventPacket(log, std::numeric_limits<Utime>::min(), std::numeric_limits<Utime>::max(),
                                  [&](const EventArray& events) {
                                    first = std::min(first, events.t.front());
                                    last = std::max(last, events.t.back());
                                    if (events.t.back() >= begin && events.t.front() < end)
                                      filler.Add(events);
                                    progress(filler.share());
                                  });
  if (last < begin || first > end) {
    throw std::runtime_error(poses_path + ": is of " + Span(begin, end) + ", the events of " + log + " of " +
                             Span(first, last) + ": another recording's poses, or another clock");
  }
  ReadFrames result = filler.Finish();
  if (result.views.size() < 3) {
    throw std::runtime_error(
        log + ": " + std::to_string(result.views.size()) + " of " + std::to_string(result.read) +
        " short times show edges, a map needs three; few events, a covered lens, or poses "
        "of another recording");
  }
  return result;
}

}  // namespace evit::mapping
