#include "tools/monitor/run_history.h"

#include "tools/monitor/page_frames.h"

namespace evit::monitor {
namespace {

constexpr std::int64_t kSpanUs = 60'000'000;
constexpr std::int64_t kPeriodUs = 100'000;
constexpr std::size_t kMost = kSpanUs / kPeriodUs;

}  // namespace

void RunHistory::Add(std::int64_t utime, FramePtr frame, Series* to) {
  if (!to->empty() && utime < to->back().first) to->clear();
  if (!to->empty() && utime - to->back().first < kPeriodUs) return;
  to->emplace_back(utime, std::move(frame));
  while (to->size() > kMost || utime - to->front().first > kSpanUs) to->pop_front();
}

FramePtr RunHistory::Encode() const {
  if (windows_.empty() && truths_.empty()) return nullptr;
  std::size_t size = 16;
  for (const Series* series : {&windows_, &truths_}) {
    if (!series->empty()) size += series->size() * series->front().second->size();
  }
  auto all = std::make_shared<Frame>(false);
  all->Reserve(size);
  all->Append(static_cast<std::uint32_t>(FrameKind::kHistory));
  all->Append(static_cast<std::uint32_t>(windows_.size()));
  all->Append(static_cast<std::uint32_t>(truths_.size()));
  all->Append(std::uint32_t{0});
  for (const Series* series : {&windows_, &truths_}) {
    for (const auto& [utime, frame] : *series) all->Append(frame->data(), frame->size());
  }
  return all;
}

}  // namespace evit::monitor
