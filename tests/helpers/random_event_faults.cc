// Faults of events: lost, too few, noise, polarity, dead and hot pixels, flicker, stamps.
#include <algorithm>
#include <cmath>
#include <set>

#include "common/text/format_text.h"
#include "tests/helpers/random_faults.h"

namespace evit::doctor {
namespace {

std::size_t PixelCount(const Sample& s) {
  return static_cast<std::size_t>(s.rig.camera.width) * static_cast<std::size_t>(s.rig.camera.height);
}

// Of an event, row by row.
std::size_t PixelOf(const Sample& s, std::size_t k) {
  return std::size_t{s.events.y[k]} * static_cast<std::size_t>(s.rig.camera.width) + s.events.x[k];
}

std::string LoseEvents(Sample* s, Chance* chance) {
  const double gap = Draw(chance, 0.08, 0.6), at = Draw(chance, 0.1, 0.8);
  const Utime first = s->events.t.front(), last = s->events.t.back();
  const Utime from = first + std::llround(at * static_cast<double>(last - first)),
              to = from + std::llround(1e6 * gap);
  KeepEvents(s, [&](std::size_t k) { return s->events.t[k] < from || s->events.t[k] > to; });
  return FormatText("%.0f ms without events", 1e3 * gap);
}

// Every pixel fires at each n-th event only, as with thresholds n times as high.
std::string RaiseThresholds(Sample* s, Chance* chance) {
  const int n = 12 + Pick(chance, 40);
  std::vector<int> seen(PixelCount(*s), 0);
  KeepEvents(s, [&](std::size_t k) {
    const std::size_t pixel = PixelOf(*s, k);
    return pixel < seen.size() && ++seen[pixel] % n == 0;
  });
  return FormatText("thresholds %d times too high", n);
}

std::string AddNoise(Sample* s, Chance* chance) {
  const double times = Draw(chance, 3, 12);  // as many as there are events
  const auto n = static_cast<std::size_t>(times * static_cast<double>(s->events.size()));
  const std::size_t most = 4'000'000;
  if (n > most) KeepEvents(s, [n](std::size_t k) { return k % (n / most + 1) == 0; });
  AddUniformEvents(s, static_cast<std::size_t>(times * static_cast<double>(s->events.size())), chance);
  return FormatText("%.1f noise events for each", times);
}

std::string SpoilPolarity(Sample* s, Chance* chance) {
  const int what = Pick(chance, 4);
  const double share = Draw(chance, 0.05, 0.15);
  for (std::uint8_t& p : s->events.p) {
    if (what < 2) p = static_cast<std::uint8_t>(what);
    if (what == 2) p = Draw(chance, 0, 1) < share ? 1 : 0;
    if (what == 3) p = static_cast<std::uint8_t>(Pick(chance, 2));
  }
  return what < 2    ? FormatText("all events have polarity %d", what)
         : what == 2 ? FormatText("%.0f %% of one polarity", 100 * share)
                     : "polarity by chance";
}

std::string KillPixels(Sample* s, Chance* chance) {
  const double share = Draw(chance, 0.04, 0.4);
  std::vector<bool> dead(PixelCount(*s));
  for (std::size_t k = 0; k < dead.size(); ++k) dead[k] = Draw(chance, 0, 1) < share;
  KeepEvents(s, [&](std::size_t k) { return !dead[PixelOf(*s, k)]; });
  return FormatText("%.0f %% of the pixels dead", 100 * share);
}

// One to a few rows or columns, together or apart.
std::string KillLines(Sample* s, Chance* chance) {
  const bool rows = Pick(chance, 2) == 0, together = Pick(chance, 2) == 0;
  const int size = rows ? s->rig.camera.height : s->rig.camera.width, n = 2 + Pick(chance, size / 20);
  std::set<int> dead;
  const int first = size / 5 + Pick(chance, size / 2);
  for (int k = 0; k < n; ++k) dead.insert(together ? first + k : size / 8 + Pick(chance, 3 * size / 4));
  KeepEvents(s, [&](std::size_t k) { return dead.count(rows ? s->events.y[k] : s->events.x[k]) == 0; });
  return FormatText("%zu %s dead, %s", dead.size(), rows ? "rows" : "columns",
                    together ? "side by side" : "here and there");
}

std::string KillBlock(Sample* s, Chance* chance) {
  const int w = s->rig.camera.width, h = s->rig.camera.height;
  const int bw = static_cast<int>(w * Draw(chance, 0.12, 0.3)),
            bh = static_cast<int>(h * Draw(chance, 0.12, 0.3));
  const int x = w / 5 + Pick(chance, w * 3 / 5 - bw), y = h / 5 + Pick(chance, h * 3 / 5 - bh);
  KeepEvents(s, [&](std::size_t k) {
    return s->events.x[k] < x || s->events.x[k] >= x + bw || s->events.y[k] < y || s->events.y[k] >= y + bh;
  });
  return FormatText("a block of %dx%d pixels dead", bw, bh);
}

std::string HeatPixels(Sample* s, Chance* chance) {
  const int w = s->rig.camera.width, h = s->rig.camera.height;
  const bool cluster = Pick(chance, 2) == 0;
  const int side = 5 + Pick(chance, 8), n = cluster ? side * side : 30 + Pick(chance, 150);
  const double hz = Draw(chance, 300, 2000);
  const int x0 = Pick(chance, w - side), y0 = Pick(chance, h - side);
  const Utime begin = s->events.t.front(), end = s->events.t.back();
  for (int k = 0; k < n; ++k) {
    const int x = cluster ? x0 + k % side : Pick(chance, w), y = cluster ? y0 + k / side : Pick(chance, h);
    for (double t = 0; t < ToSeconds(end - begin); t += Draw(chance, 0.5, 1.5) / hz)
      s->events.push_back(begin + std::llround(1e6 * t), static_cast<std::uint16_t>(x),
                          static_cast<std::uint16_t>(y), static_cast<std::uint8_t>(Pick(chance, 2)));
  }
  SortEvents(&s->events);
  return FormatText("%d hot pixels of %.0f Hz%s", n, hz, cluster ? " side by side" : "");
}

// A lamp lights all of the scene or a part: there, events come while it brightens and while it darkens.
std::string Flicker(Sample* s, Chance* chance) {
  const double mains = Either(chance, 50, 60) * Draw(chance, 0.998, 1.002), share = Draw(chance, 0.3, 1);
  const int right = static_cast<int>(share * s->rig.camera.width);
  const double phase = Draw(chance, 0, 6.28);
  const EventArray before = s->events;
  const double more = Draw(chance, 0.5, 1);
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before.x[k] >= right || Draw(chance, 0, 1) > more) continue;
    const double swing = std::sin(2 * M_PI * 2 * mains * ToSeconds(before.t[k]) + phase);
    s->events.push_back(before.t[k], before.x[k], before.y[k], swing > 0 ? 1 : 0);
  }
  SortEvents(&s->events);
  return FormatText("a lamp on %.1f Hz in %.0f %% of the image, %.1f events for each", mains, 100 * share,
                    more);
}

// Blocks of events, as a driver sends them, that overtake the one before.
std::string ShuffleEvents(Sample* s, Chance* chance) {
  const Utime block = std::llround(Draw(chance, 1'000, 20'000)), first = s->events.t.front();
  const double share = Draw(chance, 0.02, 0.3);
  const auto of = [&](std::size_t k) { return (s->events.t[k] - first) / block; };
  EventArray sent, held;  // held: overtaken by the next block
  const auto append = [&](EventArray* to, std::size_t k) {
    to->push_back(s->events.t[k], s->events.x[k], s->events.y[k], s->events.p[k]);
  };
  bool late = false;
  for (std::size_t k = 0; k < s->events.size(); ++k) {
    if (k > 0 && of(k) != of(k - 1)) {
      if (!late && held.size() > 0) {
        for (std::size_t i = 0; i < held.size(); ++i)
          sent.push_back(held.t[i], held.x[i], held.y[i], held.p[i]);
        held.clear();
      }
      late = held.size() == 0 && Draw(chance, 0, 1) < share;
    }
    append(late ? &held : &sent, k);
  }
  s->events = std::move(sent);
  return FormatText("%.0f %% of the blocks of %.1f ms overtake the one before", 100 * share,
                    static_cast<double>(block) / 1e3);
}

std::string ScaleEventStamps(Sample* s, Chance* chance) {
  const bool longer = Pick(chance, 2) == 0;
  const Utime first = s->events.t.front();
  for (Utime& t : s->events.t) t = first + (longer ? 1000 * (t - first) : (t - first) / 1000);
  return longer ? "stamps of events in ns" : "stamps of events in ms";
}

std::string RoundEventStamps(Sample* s, Chance* chance) {
  const Utime step = std::llround(Draw(chance, 2'000, 30'000));
  for (Utime& t : s->events.t) t = t / step * step;
  return FormatText("stamps of events rounded to %.1f ms", static_cast<double>(step) / 1e3);
}

std::string JumpOfEventClock(Sample* s, Chance* chance) {
  const Utime by = std::llround(Either(chance, -1, 1) * Draw(chance, 3e5, 2e6));
  const Utime first = s->events.t.front(), last = s->events.t.back();
  const Utime from = first + std::llround(Draw(chance, 0.3, 0.7) * static_cast<double>(last - first));
  for (Utime& t : s->events.t)
    if (t > from) t += by;
  return FormatText("the events' clock jumps by %+.1f s", ToSeconds(by));
}

}  // namespace

std::vector<RandomFault> RandomEventFaults() {
  return {{"events lost", {"event-gaps"}, LoseEvents},
          {"thresholds too high", {"event-rate"}, RaiseThresholds},
          {"noise", {"event-noise"}, AddNoise},
          {"polarity", {"polarity"}, SpoilPolarity},
          {"dead pixels", {"dead-pixels"}, KillPixels},
          {"dead rows and columns", {"dead-area", "dead-lines", "dead-pixels"}, KillLines},
          {"dead block", {"dead-area"}, KillBlock},
          {"hot pixels", {"hot-pixels"}, HeatPixels},
          {"flicker", {"flicker"}, Flicker},
          {"events out of order", {"event-order"}, ShuffleEvents},
          {"unit of event stamps", {"event-stamps"}, ScaleEventStamps},
          {"rounded event stamps", {"event-stamps"}, RoundEventStamps},
          {"clock of events jumps", {"event-order", "event-gaps"}, JumpOfEventClock}};
}

}  // namespace evit::doctor
