#include "tools/monitor/viewer_queue.h"

#include <utility>

namespace evit::monitor {

void ViewerQueue::Replace(const std::string& name, FramePtr frame) {
  FramePtr& place = newest_[name];
  if (place) ++dropped_;
  place = std::move(frame);
}

void ViewerQueue::ReplacePicture(FramePtr frame) {
  if (picture_) ++dropped_;
  picture_ = std::move(frame);
}

void ViewerQueue::Append(FramePtr frame) {
  if (series_.size() == kLongestSeries) {
    series_.pop_front();
    ++dropped_;
  }
  series_.push_back(std::move(frame));
}

FramePtr ViewerQueue::Next() {
  if (!newest_.empty()) {
    FramePtr frame = std::move(newest_.begin()->second);
    newest_.erase(newest_.begin());
    return frame;
  }
  if (!series_.empty()) {
    FramePtr frame = std::move(series_.front());
    series_.pop_front();
    return frame;
  }
  if (!picture_ || under_way_) return nullptr;
  under_way_ = true;
  return std::exchange(picture_, nullptr);
}

void ViewerQueue::Acknowledge() { under_way_ = false; }

bool ViewerQueue::ready() const { return !newest_.empty() || !series_.empty() || (picture_ && !under_way_); }

}  // namespace evit::monitor
