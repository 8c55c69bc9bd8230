#include "tools/render/recorded_run.h"

#include <algorithm>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/bus/codec.h"

namespace evit::render {

RecordedRun::RecordedRun(const std::string& path, const std::string& prefix) : log_(path) {
  const Channels channels(prefix);
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < log_.entries().size(); ++i) {
    const LogEntry& entry = log_.entries()[i];
    const std::string& channel = log_.channel(entry);
    if (channel != channels.window_state && channel != channels.keyframe) continue;
    log_.Read(entry, &bytes);
    if (channel == channels.window_state) {
      window_state_t window;
      if (DecodeChecked(bytes.data(), bytes.size(), &window) && !window.node.empty()) {
        windows_.push_back(std::move(window));
      }
      continue;
    }
    keyframe_t keyframe;
    if (DecodeChecked(bytes.data(), bytes.size(), &keyframe)) keyframes_.push_back({keyframe.utime, i});
  }
  if (windows_.empty()) {
    throw std::runtime_error(path + " holds no " + channels.window_state +
                             "; record a run with `evit run --record FILE`");
  }
  std::stable_sort(windows_.begin(), windows_.end(),
                   [](const window_state_t& a, const window_state_t& b) { return a.utime < b.utime; });
  std::stable_sort(keyframes_.begin(), keyframes_.end(),
                   [](const Place& a, const Place& b) { return a.utime < b.utime; });
}

std::int64_t RecordedRun::begin() const {
  const std::int64_t window = windows_.front().utime;
  return keyframes_.empty() ? window : std::min(window, keyframes_.front().utime);
}

std::size_t RecordedRun::WindowAt(std::int64_t t) const {
  const auto after =
      std::upper_bound(windows_.begin(), windows_.end(), t,
                       [](std::int64_t stamp, const window_state_t& window) { return stamp < window.utime; });
  return after == windows_.begin() ? 0 : static_cast<std::size_t>(after - windows_.begin()) - 1;
}

std::optional<keyframe_t> RecordedRun::KeyframeAt(std::int64_t t) const {
  const auto place =
      std::lower_bound(keyframes_.begin(), keyframes_.end(), t,
                       [](const Place& known, std::int64_t stamp) { return known.utime < stamp; });
  if (place == keyframes_.end() || place->utime != t) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  log_.Read(log_.entries()[place->entry], &bytes);
  keyframe_t keyframe;
  if (!DecodeChecked(bytes.data(), bytes.size(), &keyframe)) return std::nullopt;
  return keyframe;
}

}  // namespace evit::render
