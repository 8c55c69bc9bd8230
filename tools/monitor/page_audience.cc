#include "tools/monitor/page_audience.h"

#include <algorithm>
#include <exception>

#include "common/service/status_reporter.h"
#include "tools/monitor/page_frames.h"
#include "tools/monitor/status_text.h"

namespace evit::monitor {
namespace {

constexpr std::int64_t kPosePeriodUs = 15'000;        // no screen shows more
constexpr std::size_t kMapChunk = 16'384;             // points, 200 kB
constexpr std::int64_t kPicturePeriodUs = 1'000'000;  // without viewers: for one who comes

}  // namespace

void PageAudience::Connected(ClientId client, const std::string& /*protocol*/) {
  Viewer& viewer = viewers_[client];
  if (FramePtr history = history_.Encode()) viewer.queue.Append(std::move(history));
  if (picture_) viewer.queue.ReplacePicture(picture_);
  for (const auto& [name, frame] : newest_) viewer.queue.Replace(name, frame);
  wake_(client);
}

void PageAudience::Publish(const std::string& name, const std::string& text) {
  Replace(name, TextFrame(text));
}

void PageAudience::Replace(const std::string& name, const FramePtr& frame) {
  newest_[name] = frame;
  for (auto& [client, viewer] : viewers_) {
    viewer.queue.Replace(name, frame);
    wake_(client);
  }
}

void PageAudience::Received(ClientId client, std::string_view message) {
  Viewer& viewer = viewers_.at(client);
  std::string answer;
  try {
    const PageOrder order = ParsePageOrder(message);
    if (!order.changes_pipeline()) {
      TakeAcknowledgement(order.drawn_utime, &viewer);
      wake_(client);
      return;
    }
    answer = AnswerText(true, give_(order));
  } catch (const std::exception& error) {
    answer = AnswerText(false, error.what());
  }
  viewer.queue.Replace("answer", TextFrame(answer));
  wake_(client);
}

void PageAudience::TakeAcknowledgement(double drawn_utime, Viewer* viewer) const {
  viewer->queue.Acknowledge();
  if (latency_ == nullptr || drawn_utime == 0) return;
  const double ms = latency_->MsSince(static_cast<Utime>(drawn_utime), HostTime());
  if (ms >= 0) viewer->queue.Replace("drawn", TextFrame(DrawnText(ms)));
}

FramePtr PageAudience::NextOfMap(Viewer* viewer) const {
  if (map_ == nullptr) return nullptr;
  if (viewer->generation != map_->generation()) {
    viewer->generation = map_->generation();
    viewer->map_sent = 0;
  } else if (viewer->map_sent == map_->points().size()) {
    return nullptr;
  }
  const std::size_t first = viewer->map_sent;
  const std::size_t n = std::min(kMapChunk, map_->points().size() - first);
  viewer->map_sent += n;
  return EncodeMap(*map_, first, n);
}

FramePtr PageAudience::Next(ClientId client) {
  Viewer& viewer = viewers_.at(client);
  FramePtr frame = viewer.queue.Next();
  return frame ? frame : NextOfMap(&viewer);
}

void PageAudience::OnPose(const body_pose_t& pose) {
  const std::int64_t now = HostTime();
  if (now - pose_sent_ < kPosePeriodUs) return;
  pose_sent_ = now;
  Replace("pose", EncodePose(FrameKind::kPose, pose));
}

void PageAudience::OnTruth(const body_pose_t& pose) {
  const std::int64_t now = HostTime();
  if (now - truth_sent_ < kPosePeriodUs) return;
  truth_sent_ = now;
  const FramePtr frame = EncodePose(FrameKind::kTruth, pose);
  history_.AddTruth(pose, frame);
  Replace("truth", frame);
}

void PageAudience::OnMode(const tracker_mode_t& mode) {
  std::string text = ModeText(mode);
  if (text == mode_text_) return;
  mode_text_ = std::move(text);
  Publish("mode", mode_text_);
}

void PageAudience::OnPlaces(const places_t& places) { Replace("places", TextFrame(PlacesText(places))); }

void PageAudience::OnWindow(const window_state_t& window, double latency_ms) {
  const FramePtr frame = EncodeWindow(window, latency_ms);
  history_.AddWindow(window, frame);
  for (auto& [client, viewer] : viewers_) {
    viewer.queue.Append(frame);
    wake_(client);
  }
}

bool PageAudience::WantsPicture() const {
  if (viewers_.empty()) return HostTime() - pictured_ >= kPicturePeriodUs;
  return std::any_of(viewers_.begin(), viewers_.end(),
                     [](const auto& viewer) { return viewer.second.queue.wants_picture(); });
}

void PageAudience::OnPicture(const keyframe_t& keyframe, const std::vector<OverlayPoint>& points) {
  pictured_ = HostTime();
  picture_ = EncodePicture(keyframe, points);
  for (auto& [client, viewer] : viewers_) {
    viewer.queue.ReplacePicture(picture_);
    wake_(client);
  }
}

}  // namespace evit::monitor
