#include "tools/locate/start_tally.h"

#include <algorithm>

#include "common/text/format_text.h"

namespace evit::locate {
namespace {

constexpr double kSoon = 2;  // s of sensor time

}  // namespace

void StartTally::Add(const LocatorResult& result, bool right, Claim at_once) {
  ++starts_;
  at_once_right_ += at_once == Claim::kRight ? 1 : 0;
  at_once_wrong_ += at_once == Claim::kWrong ? 1 : 0;
  right_ += right ? 1 : 0;
  within_ += right && result.after_s <= kSoon ? 1 : 0;
  wrong_ += result.found && !right ? 1 : 0;
  withdrawn_ += result.withdrawn.empty() ? 0 : 1;
  cut_ += result.cut ? 1 : 0;
  if (result.found) after_.push_back(result.after_s);
  candidates_ += static_cast<double>(result.candidates.size());
  rate_ += result.events_per_s;
  search_ += result.search_s;
  cpu_ += result.cpu_s;
}

std::string StartTally::Line() const {
  std::vector<double> after = after_;
  const auto middle = after.begin() + static_cast<std::ptrdiff_t>(after.size() / 2);
  if (!after.empty()) std::nth_element(after.begin(), middle, after.end());
  const double n = std::max(1, starts_);
  return FormatText(
      "starts %d right %d within_2s %d wrong %d withdrawn %d cut %d after_s %.2f candidates %.1f "
      "events_per_s %.0f "
      "search_s %.2f "
      "cpu_s %.2f at_once_right %d at_once_wrong %d",
      starts_, right_, within_, wrong_, withdrawn_, cut_, after.empty() ? 0 : *middle, candidates_ / n,
      rate_ / n, search_ / n, cpu_ / n, at_once_right_, at_once_wrong_);
}

}  // namespace evit::locate
