#include "common/diagnosis/readout_limit.h"

#include <algorithm>

#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr std::size_t kSpell = 10;    // bins of a millisecond that are looked at together
constexpr double kFewest = 200;       // events of a bin: fewer are no sensor's limit
constexpr double kEven = 0.1;         // variance over mean; by chance one Poisson spell in 3000 has less
constexpr double kNearLargest = 0.9;  // of the largest rate of any spell
constexpr double kLongEnough = 0.05;  // s, of all spells at the limit

struct Spell {
  double mean = 0, variance = 0;  // of its bins
  bool Even() const { return mean >= kFewest && variance < kEven * mean; }
};

std::vector<Spell> SpellsOf(const std::vector<EventCensus::Bin>& bins) {
  std::vector<Spell> spells;
  for (std::size_t begin = 0; begin + kSpell <= bins.size(); begin += kSpell) {
    double sum = 0, squares = 0;
    for (std::size_t k = begin; k < begin + kSpell; ++k) {
      const double n = static_cast<double>(bins[k].brighter) + static_cast<double>(bins[k].darker);
      sum += n, squares += n * n;
    }
    const double mean = sum / kSpell;
    spells.push_back({mean, (squares - sum * mean) / (kSpell - 1)});
  }
  return spells;
}

}  // namespace

ReadoutLimit FindReadoutLimit(const std::vector<EventCensus::Bin>& bins) {
  const std::vector<Spell> spells = SpellsOf(bins);
  double largest = 0;
  for (const Spell& spell : spells) largest = std::max(largest, spell.mean);
  std::size_t n = 0;
  double sum = 0;
  for (const Spell& spell : spells)
    if (spell.Even() && spell.mean >= kNearLargest * largest) ++n, sum += spell.mean;
  constexpr double kBinSeconds = 1e-6 * static_cast<double>(EventCensus::kBin);
  if (n == 0) return {};
  return {sum / static_cast<double>(n) / kBinSeconds, static_cast<double>(n * kSpell) * kBinSeconds};
}

std::optional<Finding> CheckReadoutLimit(const EventCensus& events) {
  const ReadoutLimit limit = FindReadoutLimit(events.bins());
  if (limit.seconds < kLongEnough) return {};
  return Finding{
      "event-rate", Severity::kWarning,
      FormatText("%.2f million events/s, evenly, for %.2f of %.1f s", limit.rate / 1e6, limit.seconds,
                 events.seconds()),
      "Events come as fast as the sensor's readout or a rate limit lets them: there they are late by "
      "milliseconds, or lost.",
      "raise the camera's thresholds (bias_diff_on, bias_diff_off), lift the driver's event rate limit, move "
      "more slowly, or mask a part of the image that need not be seen"};
}

}  // namespace evit::diagnosis
