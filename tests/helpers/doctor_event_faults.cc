#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "tests/helpers/doctor_faults.h"

namespace evit::doctor {
namespace {

// Whether pixels fire so often that one without any event is not chance.
bool FiresEverywhere(const Sample& s) {
  return s.events.size() > 5 * static_cast<std::size_t>(s.rig.camera.width * s.rig.camera.height);
}

// Without the events of a rectangle, given as shares of the image.
void SilencePixels(Sample* s, double left, double top, double right, double bottom) {
  const int w = s->rig.camera.width, h = s->rig.camera.height;
  KeepEvents(s, [&](std::size_t k) {
    const int x = s->events.x[k], y = s->events.y[k];
    return x < left * w || x >= right * w || y < top * h || y >= bottom * h;
  });
}

}  // namespace

std::vector<Fault> EventFaults() {
  return {
      {"PolarityLost", "polarity", [](Sample* s) { std::fill(s->events.p.begin(), s->events.p.end(), 1); }},
      {"PixelsOfAnotherCamera", "sensor-size",
       [](Sample* s) {
         Camera& c = s->rig.camera;
         c.width = c.width * 3 / 4, c.height = c.height * 3 / 4, c.cx *= 0.75, c.cy *= 0.75;
       }},
      {"RigOfTwiceTheResolution", "sensor-size",
       [](Sample* s) {
         Camera& c = s->rig.camera;
         c.width *= 2, c.height *= 2, c.fx *= 2, c.fy *= 2, c.cx *= 2, c.cy *= 2;
       }},
      {"EventsLostForThreeTenthsOfASecond", "event-gaps",
       [](Sample* s) {
         KeepEvents(s, [s](std::size_t k) {
           return std::abs(s->events.t[k] - s->imu.front().t - 1'500'000) > 150'000;
         });
       }},
      {"ATenthOfThePixelsDead", "dead-pixels",
       [](Sample* s) {
         KeepEvents(
             s, [s](std::size_t k) { return (s->events.x[k] * 7919 + s->events.y[k] * 104729) % 10 != 0; });
       },
       FiresEverywhere},
      {"HotPixels", "hot-pixels",
       [](Sample* s) {
         std::mt19937 random(1);
         const auto width = static_cast<unsigned>(s->rig.camera.width),
                    height = static_cast<unsigned>(s->rig.camera.height);
         const Utime begin = s->events.t.front(), end = s->events.t.back();
         for (int n = 0; n < 60; ++n) {
           const auto x = static_cast<std::uint16_t>(random() % width),
                      y = static_cast<std::uint16_t>(random() % height);
           for (Utime t = begin; t < end; t += 500) s->events.push_back(t, x, y, t / 500 % 2);
         }
         SortEvents(&s->events);
       }},
      {"Noise", "event-noise",
       [](Sample* s) {
         std::mt19937 random(2);
         const auto width = static_cast<unsigned>(s->rig.camera.width),
                    height = static_cast<unsigned>(s->rig.camera.height);
         KeepEvents(s, [](std::size_t k) { return k % 20 == 0; });
         const Utime begin = s->events.t.front(), end = s->events.t.back();
         for (int n = 0; n < 300'000; ++n)
           s->events.push_back(begin + static_cast<Utime>(random() % static_cast<std::uint32_t>(end - begin)),
                               static_cast<std::uint16_t>(random() % width),
                               static_cast<std::uint16_t>(random() % height), random() % 2);
         SortEvents(&s->events);
       }},
      {"LampOnMains", "flicker",
       [](Sample* s) {
         const EventArray before = s->events;
         for (std::size_t k = 0; k < before.size(); k += 2) {
           const double phase = 2 * M_PI * 100 * ToSeconds(before.t[k]);
           s->events.push_back(before.t[k], before.x[k], before.y[k], std::sin(phase) > 0 ? 1 : 0);
         }
         SortEvents(&s->events);
       }},
      {"LensCovered", "event-rate",
       [](Sample* s) { KeepEvents(s, [](std::size_t k) { return k % 1000 == 0; }); }},
      {"ImuOnAnotherClock", "clocks",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.t += 3'000'000'000;
         for (StampedPose& p : s->truth) p.t += 3'000'000'000;
       }},
      {"PixelsSubsampled", "dead-lines",
       [](Sample* s) {
         KeepEvents(s, [s](std::size_t k) { return s->events.x[k] % 2 == 0 && s->events.y[k] % 2 == 0; });
       }},
      {"StripeOfColumnsDead", "dead-area", [](Sample* s) { SilencePixels(s, 0.55, 0, 0.63, 1); }},
      {"StripeOfRowsDead", "dead-area", [](Sample* s) { SilencePixels(s, 0, 0.3, 1, 0.35); }},
      {"ColumnsAtTheEdgeDead", "dead-area", [](Sample* s) { SilencePixels(s, 0, 0, 0.1, 1); },
       FiresEverywhere},
      {"BlockOfPixelsDead", "dead-area", [](Sample* s) { SilencePixels(s, 0.4, 0.35, 0.65, 0.6); }},
      {"MostEventsOfOnePolarity", "polarity",
       [](Sample* s) {
         for (std::size_t k = 0; k < s->events.size(); ++k) s->events.p[k] = k % 10 == 0 ? 0 : 1;
       }},
      {"LampOn60HertzMains", "flicker",
       [](Sample* s) {
         const EventArray before = s->events;
         for (std::size_t k = 0; k < before.size(); ++k) {
           const double phase = 2 * M_PI * 120 * ToSeconds(before.t[k]);
           s->events.push_back(before.t[k], before.x[k], before.y[k], std::sin(phase) > 0 ? 1 : 0);
         }
         SortEvents(&s->events);
       }},
      {"EventsLostAgainAndAgain", "event-gaps",
       [](Sample* s) {
         const Utime first = s->imu.front().t;
         KeepEvents(s, [s, first](std::size_t k) { return (s->events.t[k] - first) % 500'000 > 120'000; });
       }},
      {"NoiseFromEverywhere", "event-noise",
       [](Sample* s) {
         std::mt19937 random(4);
         KeepEvents(s, [](std::size_t k) { return k % 30 == 0; });
         const Utime begin = s->events.t.front(), end = s->events.t.back();
         for (int n = 0; n < 200'000; ++n)
           s->events.push_back(
               begin + static_cast<Utime>(random() % static_cast<std::uint32_t>(end - begin)),
               static_cast<std::uint16_t>(random() % static_cast<unsigned>(s->rig.camera.width)),
               static_cast<std::uint16_t>(random() % static_cast<unsigned>(s->rig.camera.height)), 1);
         for (std::size_t k = 0; k < s->events.size(); k += 2) s->events.p[k] = 0;
         SortEvents(&s->events);
       }},
  };
}

}  // namespace evit::doctor
