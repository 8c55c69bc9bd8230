#include "common/diagnosis/dead_lines.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "common/diagnosis/median.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr std::int64_t kFewestInLine =
    150;                               // events of a line right beside: none by chance would be unheard of
constexpr double kStrayInLine = 0.02;  // of those: damaged data, not a pixel
constexpr double kAlikeLines = 0.6;    // of what fires further out
constexpr int kFurtherLines = 5;       // lines
constexpr std::ptrdiff_t kWidestLines = 12;  // one part in so many: a wider one is an area
constexpr double kManyLines = 0.2;           // of a sensor's: no defect, but a camera that skips pixels

// Events of each row or column; of a pixel at most ten times the usual, so that no hot one hides a dead line.
std::vector<std::int64_t> LineCounts(const EventCensus& e, bool rows) {
  std::vector<double> counts;
  for (const std::uint32_t n : e.by_pixel())
    if (n > 0) counts.push_back(n);
  const auto most = counts.empty() ? 0 : static_cast<std::uint32_t>(10 * Median(counts));
  std::vector<std::int64_t> sums(static_cast<std::size_t>(rows ? e.height() : e.width()), 0);
  std::size_t pixel = 0;
  for (int y = 0; y < e.height(); ++y)
    for (int x = 0; x < e.width(); ++x)
      sums[static_cast<std::size_t>(rows ? y : x)] += std::min(e.by_pixel()[pixel++], most);
  return sums;
}

// Whether the line beside dead ones fires, and as often as those further out in the direction of `step`.
bool LineIsBusy(const std::vector<std::int64_t>& sums, std::ptrdiff_t beside, std::ptrdiff_t step) {
  const auto size = static_cast<std::ptrdiff_t>(sums.size());
  if (beside < 0 || beside >= size || sums[static_cast<std::size_t>(beside)] < kFewestInLine) return false;
  std::vector<double> further;
  for (int k = 1; k <= kFurtherLines; ++k) {
    const std::ptrdiff_t at = beside + k * step;
    if (at >= 0 && at < size) further.push_back(static_cast<double>(sums[static_cast<std::size_t>(at)]));
  }
  return further.empty() ||
         static_cast<double>(sums[static_cast<std::size_t>(beside)]) >= kAlikeLines * Median(further);
}

// How many lines are dead, and the first of them.
std::pair<int, int> CountDeadLines(const std::vector<std::int64_t>& sums) {
  int dead = 0, first = -1;
  const auto size = static_cast<std::ptrdiff_t>(sums.size());
  for (std::ptrdiff_t begin = 1; begin < size; ++begin) {
    const double limit = kStrayInLine * static_cast<double>(sums[static_cast<std::size_t>(begin - 1)]);
    std::ptrdiff_t end = begin;
    while (end < size && static_cast<double>(sums[static_cast<std::size_t>(end)]) <= limit) ++end;
    if (end == begin || end == size) continue;  // the last ones: a smaller sensor, or a plain part
    if (kWidestLines * (end - begin) <= size && LineIsBusy(sums, begin - 1, -1) && LineIsBusy(sums, end, 1)) {
      if (first < 0) first = static_cast<int>(begin);
      dead += static_cast<int>(end - begin);
    }
    begin = end;
  }
  return {dead, first};
}

}  // namespace

DeadLines FindDeadLines(const EventCensus& events) {
  DeadLines found;
  std::tie(found.rows, found.first_row) = CountDeadLines(LineCounts(events, true));
  std::tie(found.columns, found.first_column) = CountDeadLines(LineCounts(events, false));
  return found;
}

Finding CheckDeadLines(const EventCensus& events) {
  const DeadLines dead = FindDeadLines(events);
  const std::string figure =
      FormatText("%d rows and %d columns silent among busy ones", dead.rows, dead.columns);
  if (dead.rows + dead.columns < 2) return Good("dead-lines", figure);
  std::string what;
  if (dead.rows > 0) what = FormatText("%d rows of pixels, the first is %d, ", dead.rows, dead.first_row);
  if (dead.columns > 0)
    what += FormatText("%s%d columns of pixels, the first is %d, ", what.empty() ? "" : "and ", dead.columns,
                       dead.first_column);
  what += "never fire though those beside them do.";
  if (dead.rows > kManyLines * events.height() || dead.columns > kManyLines * events.width())
    return {"dead-lines", Severity::kError, figure, what,
            "switch off what skips rows or columns of pixels (subsampling, filters) in camera and driver"};
  return {
      "dead-lines", Severity::kWarning, figure, what,
      "look for masked rows or columns, or lost packets, in camera and driver; EVIT tracks with the rest"};
}

}  // namespace evit::diagnosis
