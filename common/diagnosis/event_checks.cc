#include "common/diagnosis/event_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/diagnosis/dead_area.h"
#include "common/diagnosis/dead_lines.h"
#include "common/diagnosis/flicker.h"
#include "common/diagnosis/readout_limit.h"
#include "common/events/known_sensors.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

// Place of a pixel in a row-major image.
std::size_t At(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

Finding Rate(const EventCensus& e) {
  const double seconds = std::max(e.seconds(), 1e-3);
  const double rate = static_cast<double>(e.count()) / seconds;
  const double per_pixel = rate / static_cast<double>(e.by_pixel().size());
  const std::string figure = FormatText("%lld events in %.1f s: %.2f million/s",
                                        static_cast<long long>(e.count()), e.seconds(), rate / 1e6);
  // Half a second without light is a covered lens; an event per pixel in 20 s is noise alone, or a rig at
  // rest.
  if (per_pixel < 0.05) {
    return {"event-rate", Severity::kError, figure,
            "There are too few events: the camera did not move, the lens was covered, or its thresholds "
            "are set far too high.",
            "record while moving; lower the camera's contrast thresholds (bias_diff_on, bias_diff_off)"};
  }
  if (const auto limited = CheckReadoutLimit(e)) return *limited;
  return Good("event-rate", figure);
}

Finding Gaps(const EventCensus& e) {
  std::size_t longest = 0, run = 0, at = 0;
  for (std::size_t k = 0; k < e.bins().size(); ++k) {
    run = e.bins()[k].brighter + e.bins()[k].darker == 0 ? run + 1 : 0;
    if (run > longest) longest = run, at = k + 1 - run;
  }
  const double ms = static_cast<double>(longest);
  const std::string figure = FormatText("longest time without an event: %.0f ms", ms);
  const double rate = static_cast<double>(e.count()) / std::max(e.seconds(), 1e-3);
  // At `rate` chance leaves no gap of twenty expected events.
  if (ms > 50 && ms / 1e3 * rate > 1000) {
    return {"event-gaps", ms > 500 ? Severity::kError : Severity::kWarning, figure,
            FormatText("No events for %.0f ms, %.2f s after the first one: the driver lost them, or the lens "
                       "was covered.",
                       ms, static_cast<double>(at) / 1e3),
            "look for losses on USB (cable, hub, event rate limit of the driver); the IMU bridges two "
            "seconds at most"};
  }
  return Good("event-gaps", figure);
}

Finding Order(const EventCensus& e) {
  const double share =
      static_cast<double>(e.backward()) / static_cast<double>(std::max<std::int64_t>(1, e.count()));
  const std::string figure = FormatText("%lld events out of order", static_cast<long long>(e.backward()));
  if (e.backward() == 0) return Good("event-order", figure);
  return {"event-order", share > 1e-3 ? Severity::kError : Severity::kWarning, figure,
          FormatText("Stamps of events go back %.2g %% of the time.", 100 * share),
          "import the recording again (`evit import` sorts within a window), or sort by time in the driver"};
}

Finding Polarity(const EventCensus& e) {
  const double on =
      static_cast<double>(e.brighter()) / static_cast<double>(std::max<std::int64_t>(1, e.count()));
  const EventCensus::Company& company = e.company();
  const double in_company = static_cast<double>(std::max<std::int64_t>(1, company.alike + company.unlike)),
               alike = static_cast<double>(company.alike) / in_company;
  const std::string figure =
      FormatText("%.0f %% brighter; %.0f %% as their neighbours just before", 100 * on, 100 * alike);
  if (on < 0.02 || on > 0.98) {
    return {
        "polarity", Severity::kError, figure,
        "All events have one polarity: it was lost on the way, or one kind of event is switched off in the "
        "camera.",
        "check how polarity is coded (0/1, -1/1) where the recording was converted, and the camera's biases"};
  }
  // Of edges, what fires beside another has its polarity; of thin lines, three in four.
  if (company.alike + company.unlike > 1000 && alike < 0.6) {
    return {"polarity", Severity::kWarning, figure,
            "Polarity is as by chance: neighbours on an edge do not have the same, as they must.",
            "look at how polarity is read where the recording was converted; EVIT itself does not need it"};
  }
  if (on < 0.2 || on > 0.8) {
    return {"polarity", Severity::kWarning, figure, "One polarity is far more frequent than the other.",
            "balance the camera's thresholds (bias_diff_on, bias_diff_off)"};
  }
  return Good("polarity", figure);
}

// The sensor whose events lie in so many columns and rows: the last ones may just have seen nothing.
std::string AtLeast(int columns, int rows) {
  const auto sensor = SmallestKnownSensor(columns, rows);
  const std::string known =
      sensor ? FormatText(" (of sensors that are sold: %dx%d)", sensor->first, sensor->second) : "";
  return FormatText("at least %dx%d pixels", columns, rows) + known;
}

Finding Size(const EventCensus& e) {
  const std::string figure = FormatText("events up to (%d, %d); the rig file's camera has %dx%d", e.max_x(),
                                        e.max_y(), e.width(), e.height());
  const double out =
      static_cast<double>(e.outside()) / static_cast<double>(std::max<std::int64_t>(1, e.count()));
  if (out > 1e-3) {
    return {"sensor-size", Severity::kError, figure,
            FormatText("%.1f %% of the events lie outside the camera of the rig file: it is another "
                       "camera's, or another resolution's.",
                       100 * out),
            FormatText("use the rig file of this camera, %s, with the intrinsics of that resolution",
                       AtLeast(e.max_x() + 1, e.max_y() + 1).c_str())};
  }
  std::int64_t inside = 0;
  const int w = e.width(), h = e.height();
  int used_x = 0, used_y = 0;
  std::vector<std::int64_t> columns(static_cast<std::size_t>(w), 0), rows(static_cast<std::size_t>(h), 0);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const std::uint32_t n = e.by_pixel()[At(x, y, w)];
      columns[static_cast<std::size_t>(x)] += n, rows[static_cast<std::size_t>(y)] += n, inside += n;
    }
  }
  const auto last_used = [inside](const std::vector<std::int64_t>& sums) {
    // Dark parts of a scene still have noise; what is not there has nothing, but for a few damaged events.
    const double few = 3 + 1e-4 * static_cast<double>(inside) / static_cast<double>(sums.size());
    int last = 0;
    for (std::size_t k = 0; k < sums.size(); ++k)
      if (static_cast<double>(sums[k]) > few) last = static_cast<int>(k) + 1;
    return last;
  };
  used_x = last_used(columns), used_y = last_used(rows);
  if (inside > 1000 && (used_x < 0.85 * w || used_y < 0.85 * h)) {
    return {"sensor-size", Severity::kError, figure,
            FormatText("Events fill only the first %dx%d pixels of the %dx%d of the rig file: it is for "
                       "another resolution, or a region of interest is set.",
                       used_x, used_y, w, h),
            FormatText("use a rig file of this sensor, %s, with the intrinsics of that resolution",
                       AtLeast(used_x, used_y).c_str())};
  }
  return Good("sensor-size", figure);
}

Finding HotPixels(const EventCensus& e) {
  std::vector<std::uint32_t> sorted;
  for (const std::uint32_t n : e.by_pixel())
    if (n > 0) sorted.push_back(n);
  if (sorted.size() < 100) return Good("hot-pixels", "too few pixels to tell");
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() * 99 / 100];
  const double limit = std::max({10 * usual, 50.0 * std::max(e.seconds(), 0.1)});  // 50 Hz at least
  std::int64_t hot = 0, from_hot = 0;
  for (const std::uint32_t n : sorted)
    if (n > limit) ++hot, from_hot += n;
  const double share = static_cast<double>(from_hot) / static_cast<double>(e.count());
  const std::string figure =
      FormatText("%lld hot pixels with %.1f %% of the events", static_cast<long long>(hot), 100 * share);
  if (share > 0.07 || hot > static_cast<std::int64_t>(e.by_pixel().size() / 500)) {
    return {"hot-pixels", share > 0.5 ? Severity::kError : Severity::kWarning, figure,
            "Some pixels fire without a cause, again and again.",
            "mask them in the driver; EVIT leaves out pixels above `surface.hot_pixel_rate_hz`"};
  }
  return Good("hot-pixels", figure);
}

// Pixels without an event among others that have many.
Finding DeadPixels(const EventCensus& e) {
  constexpr int kFewestBusy = 5;       // of 24 around
  constexpr double kBusy = 12;         // events of each, mean: by chance none in 160,000 would then be silent
  constexpr std::uint32_t kMost = 24;  // count of each: a hot pixel does not make its neighbours busy
  const int w = e.width(), h = e.height();
  std::int64_t judged = 0, dead = 0;
  for (int y = 2; y + 2 < h; ++y) {
    for (int x = 2; x + 2 < w; ++x) {
      std::int64_t around = 0, busy = 0;
      for (int v = -2; v <= 2; ++v)
        for (int u = -2; u <= 2; ++u) {
          const std::uint32_t n = e.by_pixel()[At(x + u, y + v, w)];
          if (u != 0 || v != 0) around += std::min(n, kMost), busy += n > 0 ? 1 : 0;
        }
      if (busy < kFewestBusy || static_cast<double>(around) < kBusy * static_cast<double>(busy)) continue;
      ++judged;
      if (e.by_pixel()[At(x, y, w)] == 0) ++dead;
    }
  }
  const double share = static_cast<double>(dead) / static_cast<double>(std::max<std::int64_t>(1, judged));
  const std::string figure = FormatText("%lld of %lld pixels silent among busy ones",
                                        static_cast<long long>(dead), static_cast<long long>(judged));
  if (judged > 1000 && share > 0.02) {
    return {"dead-pixels", share > 0.3 ? Severity::kError : Severity::kWarning, figure,
            FormatText("%.0f %% of the pixels never fire though all around them do.", 100 * share),
            "look for a mask or a subsampling in the driver; EVIT tracks with half of the pixels, not with a "
            "tenth"};
  }
  return Good("dead-pixels", figure);
}

// The share of noise: how many events have no company, of how many would have none if all were noise. In the
// longest time in which noise of this rate would still be without company half of the time.
Finding Noise(const EventCensus& e) {
  constexpr double kTelling = 0.5;
  const EventCensus::Company& company = e.company();
  const double rate = static_cast<double>(e.count()) / std::max(e.seconds(), 1e-3) /
                      static_cast<double>(e.by_pixel().size());  // of a pixel
  std::size_t k = 0;
  const auto chance = [&] {
    return std::exp(-rate * EventCensus::Company::kPixels * ToSeconds(EventCensus::Company::kWithin[k]));
  };
  while (chance() < kTelling && k + 1 < EventCensus::Company::kWithin.size()) ++k;
  const double judged = static_cast<double>(std::max<std::int64_t>(1, company.judged));
  const double share = std::min(1.0, static_cast<double>(company.alone[k]) / judged / chance());
  const std::string figure = FormatText("%.0f %% of the events isolated, as noise is", 100 * share);
  if (chance() > 0.1 && share > 0.6) {
    return {"event-noise", share > 0.85 ? Severity::kError : Severity::kWarning, figure,
            "Most events have no other near them in space and time: noise, or too little motion.",
            "raise the camera's thresholds or its low-pass (bias_fo), give it more light, move more"};
  }
  return Good("event-noise", figure);
}

}  // namespace

Findings CheckEvents(const EventCensus& events) {
  if (events.count() == 0) {
    return {{"event-rate", Severity::kError, "no event", "The recording holds no events on EVENTS.",
             "import it again, and look at what `evit import` counts"}};
  }
  Findings found{Rate(events), Order(events), Polarity(events), Size(events)};
  // Where the sensor is a smaller one, what it does not have is no fault of its pixels.
  const bool whole = found.back().severity == Severity::kGood;
  for (Finding& finding :
       Findings{Gaps(events), HotPixels(events), DeadPixels(events), CheckFlicker(events), Noise(events)})
    found.push_back(std::move(finding));
  if (whole) {
    found.push_back(CheckDeadArea(events));
    found.push_back(CheckDeadLines(events));
  }
  return found;
}

}  // namespace evit::diagnosis
