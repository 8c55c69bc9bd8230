#include "tools/mapping/frame_list.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "common/files/decimal_time.h"

namespace evit::mapping {
namespace {

std::string Span(Utime begin, Utime end) {
  char text[80];
  std::snprintf(text, sizeof text, "%.3f to %.3f s", static_cast<double>(begin) * 1e-6,
                static_cast<double>(end) * 1e-6);
  return text;
}

Utime MedianInterval(const Trajectory& poses) {
  std::vector<Utime> intervals;
  for (std::size_t k = 1; k < poses.size(); ++k) intervals.push_back(poses[k].t - poses[k - 1].t);
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

// Whole numbers in `unit`; with a point always seconds.
std::vector<Utime> StampsIn(const std::vector<formats::FrameSource::Frame>& frames,
                            std::optional<TimeUnit> unit) {
  std::vector<Utime> stamps;
  for (const formats::FrameSource::Frame& frame : frames) {
    const bool decimal = frame.stamp.find('.') != std::string::npos;
    const TimeUnit date = UnitOfDate(frame.stamp).value_or(TimeUnit::kSeconds);
    Utime t = 0;
    if (!ParseDecimalTime(frame.stamp, decimal ? TimeUnit::kSeconds : unit.value_or(date), &t)) return {};
    stamps.push_back(t);
  }
  return stamps;
}

std::size_t CountWithin(const std::vector<Utime>& stamps, Utime begin, Utime end) {
  return static_cast<std::size_t>(
      std::count_if(stamps.begin(), stamps.end(), [&](Utime t) { return t >= begin && t <= end; }));
}

// To within a millisecond.
bool HasPoseAt(const Trajectory& poses, Utime t) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), t - 1'000,
                                      [](const StampedPose& pose, Utime time) { return pose.t < time; });
  return after != poses.end() && after->t <= t + 1'000;
}

}  // namespace

std::optional<std::vector<Utime>> StampsOf(const formats::FrameSource& source, Utime begin, Utime end) {
  for (const formats::FrameSource::Frame& frame : source.frames()) {
    if (frame.stamp.empty()) return std::nullopt;
  }
  std::vector<Utime> best = StampsIn(source.frames(), std::nullopt);
  std::size_t most = CountWithin(best, begin, end);
  for (const TimeUnit unit :
       {TimeUnit::kSeconds, TimeUnit::kMilliseconds, TimeUnit::kMicroseconds, TimeUnit::kNanoseconds}) {
    std::vector<Utime> stamps = StampsIn(source.frames(), unit);
    const std::size_t within = CountWithin(stamps, begin, end);
    if (within > most) most = within, best = std::move(stamps);
  }
  if (best.empty()) return std::nullopt;
  return best;
}

FrameList ListFrames(const formats::FrameSource& source, const std::string& path, const Trajectory& poses,
                     const std::string& poses_path) {
  if (poses.empty()) throw std::runtime_error(poses_path + ": holds no pose");
  const Utime begin = poses.front().t, end = poses.back().t;
  const auto stamps = StampsOf(source, begin, end);
  const std::size_t n = source.frames().size();
  FrameList list;
  list.pose_interval = MedianInterval(poses);
  list.by_stamp = stamps && CountWithin(*stamps, begin, end) > 0;
  if (!list.by_stamp) {
    list.stamps_ignored = stamps.has_value();
    if (n == poses.size()) {
      for (std::size_t k = 0; k < n; ++k) list.frames.push_back({k, poses[k].t, poses[k].pose});
      return list;
    }
    std::string why = path + ": " + std::to_string(n) + " pictures, but " + poses_path + " has " +
                      std::to_string(poses.size()) + " poses";
    if (stamps) {
      const auto [first, last] = std::minmax_element(stamps->begin(), stamps->end());
      why += ", of " + Span(begin, end) + ", and no picture was taken then (" + Span(*first, *last) +
             "): another recording's poses, or another clock";
    } else {
      why += "; expected one for each in the order of names, or a list images.txt with \"stamp name\" lines";
    }
    throw std::runtime_error(why);
  }
  for (std::size_t k = 0; k < n; ++k) {
    Frame frame{k, (*stamps)[k], {}};
    if (PoseAt(poses, frame.t, &frame.T_map_camera)) {
      if (!HasPoseAt(poses, frame.t)) ++list.between_poses;
      list.frames.push_back(frame);
    } else {
      ++list.without_pose;
    }
  }
  if (list.frames.size() < 3) {
    throw std::runtime_error(
        poses_path + ": only " + std::to_string(list.frames.size()) + " of " + std::to_string(n) +
        " pictures of " + path + " have a pose, a map needs three; poses are of " + Span(begin, end) + ", " +
        std::to_string(list.pose_interval / 1000) + " ms apart (over more than 200 ms none is interpolated)");
  }
  std::stable_sort(list.frames.begin(), list.frames.end(),
                   [](const Frame& a, const Frame& b) { return a.t < b.t; });
  return list;
}

std::pair<std::size_t, std::size_t> ParseRange(const std::string& range) {
  std::size_t begin = 0, end = 0;
  char colon = 0;
  std::istringstream text(range);
  if (!(text >> begin >> colon >> end) || colon != ':' || !text.eof() || begin >= end) {
    throw std::runtime_error("--frames " + range + ": expected A:B with A below B, two counts of pictures");
  }
  return {begin, end};
}

void TakeRange(const std::string& range, FrameList* list) {
  auto [begin, end] = ParseRange(range);
  end = std::min(end, list->frames.size());
  if (begin >= end)
    throw std::runtime_error("--frames " + range + ": there are only " + std::to_string(list->frames.size()) +
                             " pictures with poses");
  list->frames = {list->frames.begin() + static_cast<std::ptrdiff_t>(begin),
                  list->frames.begin() + static_cast<std::ptrdiff_t>(end)};
}

}  // namespace evit::mapping
