#include "common/diagnosis/clock_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/alignment/clock_alignment.h"
#include "common/diagnosis/rising_samples.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr Utime kBin = 10'000;  // us

// Into bins of kBin since `begin`, as logarithms, with NaN where there is nothing to say.
std::vector<double> EventRates(const EventCensus& events, std::size_t size) {
  std::vector<double> rates(size, std::nan(""));
  const std::size_t per = kBin / EventCensus::kBin;
  double total = 0, known = 0;
  std::vector<bool> empty;
  for (std::size_t k = 0; k < size && (k + 1) * per <= events.bins().size(); ++k) {
    double n = 0;
    for (std::size_t b = k * per; b < (k + 1) * per; ++b)
      n += static_cast<double>(events.bins()[b].brighter) + static_cast<double>(events.bins()[b].darker);
    rates[k] = std::log(n + 10);
    total += n, ++known;
    empty.push_back(n == 0);
  }
  // What a driver lost says nothing of the motion: as long without an event as would else hold a thousand.
  const double hole = 1000 * known / std::max(total, 1.0);
  for (std::size_t begin = 0; begin < empty.size(); ++begin) {
    std::size_t end = begin;
    while (end < empty.size() && empty[end]) ++end;
    if (static_cast<double>(end - begin) > std::max(hole, 5.0)) {
      // With the bins that it begins and ends in.
      for (std::size_t k = begin > 0 ? begin - 1 : 0; k < std::min(end + 1, empty.size()); ++k)
        rates[k] = std::nan("");
    }
    begin = std::max(begin, end);
  }
  return rates;
}

std::vector<double> GyroRates(const std::vector<ImuSample>& imu, Utime begin, std::size_t size) {
  std::vector<double> sums(size, 0), counts(size, 0);
  for (const ImuSample& s : imu) {
    const Utime k = (s.t - begin) / kBin;
    if (s.t < begin || k >= static_cast<Utime>(size)) continue;
    sums[static_cast<std::size_t>(k)] += s.gyro.norm(), counts[static_cast<std::size_t>(k)] += 1;
  }
  for (std::size_t k = 0; k < size; ++k)
    sums[k] = counts[k] > 0 ? std::log(sums[k] / counts[k] + 0.02) : std::nan("");
  return sums;
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t shift) {
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::ptrdiff_t k = 0; k < static_cast<std::ptrdiff_t>(a.size()); ++k) {
    const std::ptrdiff_t j = k + shift;
    if (j < 0 || j >= static_cast<std::ptrdiff_t>(b.size())) continue;
    const double x = a[static_cast<std::size_t>(k)], y = b[static_cast<std::size_t>(j)];
    if (std::isnan(x) || std::isnan(y)) continue;
    n += 1, sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
  }
  if (n < 0.5 * static_cast<double>(a.size()) || n < 100) return 0;
  const double va = saa - sa * sa / n, vb = sbb - sb * sb / n;
  return va > 1e-9 && vb > 1e-9 ? (sab - sa * sb / n) / std::sqrt(va * vb) : 0;
}

Finding Span(const EventCensus& events, const std::vector<ImuSample>& imu, Utime time_offset) {
  const auto [first, last] = std::minmax_element(
      imu.begin(), imu.end(), [](const ImuSample& a, const ImuSample& b) { return a.t < b.t; });
  const Utime begin = events.first() + time_offset, end = events.last() + time_offset;
  const double both = ToSeconds(std::min(end, last->t) - std::max(begin, first->t));
  const double shorter = std::min(ToSeconds(end - begin), ToSeconds(last->t - first->t));
  const std::string figure = FormatText("events %.3f to %.3f s, IMU %.3f to %.3f s", ToSeconds(begin),
                                        ToSeconds(end), ToSeconds(first->t), ToSeconds(last->t));
  if (both < 0.5 * shorter) {
    return {
        "clocks", Severity::kError, figure,
        both <= 0
            ? FormatText("Events and IMU never overlap: they begin %.3f s apart, so they are on two clocks.",
                         std::abs(ToSeconds(begin - first->t)))
            : FormatText("Events and IMU overlap for %.1f s only.", both),
        "stamp both by one clock, or state the difference as camera.time_offset_us in the rig file or where "
        "they are imported"};
  }
  return Good("clocks", figure);
}

Finding Lag(const EventCensus& events, const std::vector<ImuSample>& imu, Utime time_offset) {
  const RateLag lag = FindRateLag(events, imu, time_offset);
  const std::string figure =
      FormatText("event rate follows the gyro best at %+.0f ms (correlation %.2f; at 0 ms %.2f)",
                 1e3 * ToSeconds(lag.lag), lag.correlation, lag.as_is);
  // What the event rate has in common with the gyro varies; only a clear peak that is clearly elsewhere
  // counts.
  if (std::abs(lag.lag) >= 40'000 && lag.correlation > 0.5 && lag.correlation > lag.as_is + 0.15) {
    return {
        "time-offset", Severity::kError, figure,
        FormatText("The camera's clock is some %.0f ms off the IMU's.", 1e3 * ToSeconds(lag.lag)),
        FormatText(
            "set `time_offset_us: %.0f` in the rig file's camera, then let `evit calibrate` find it exactly",
            static_cast<double>(time_offset + lag.lag))};
  }
  return Good("time-offset", figure);
}

// Of image and gyro; good where motion is too little, or too steady, to tell. `rates`: what the event rate
// measured, which was good.
Finding Turning(const std::vector<FlowSample>& flow, const std::vector<ImuSample>& unordered,
                Utime time_offset, const std::string& rates) {
  constexpr double kByTranslation = 25'000, kLeastExplained = 0.5;
  constexpr Utime kReach = 200'000;
  const std::vector<ImuSample> imu = RisingSamples(unordered);
  std::vector<FlowSample> of_imu = flow;
  for (FlowSample& s : of_imu) s.t += time_offset;
  const RotationLag lag = FindRotationLag(of_imu, imu, kReach);
  if (lag.pairs == 0) return Good("time-offset", rates + "; the image's motion does not tell");
  const auto ms = [](double us) { return us / 1e3; };
  const auto off = static_cast<double>(-lag.offset);  // to add to the events' stamps
  const std::string figure =
      FormatText("the image turns with the gyro at %+.0f +-%.0f ms (%.0f %% explained; at 0 ms %.0f %%)",
                 ms(off), ms(lag.sigma), 100 * lag.explained, 100 * lag.explained_as_is);
  if (lag.explained < kLeastExplained || std::abs(off) < kByTranslation + 4 * lag.sigma)
    return Good("time-offset", rates + "; " + figure);
  return {
      "time-offset", Severity::kWarning, figure,
      FormatText("The camera's clock is some %.0f ms off the IMU's.", ms(off)),
      FormatText(
          "set `time_offset_us: %.0f` in the rig file's camera, then let `evit calibrate` find it exactly",
          static_cast<double>(time_offset) + off)};
}

}  // namespace

RateLag FindRateLag(const EventCensus& events, const std::vector<ImuSample>& imu, Utime time_offset,
                    Utime reach) {
  RateLag best;
  const auto size = static_cast<std::size_t>((events.last() - events.first()) / kBin);
  if (size < 150) return best;
  const std::vector<double> rates = EventRates(events, size),
                            gyro = GyroRates(imu, events.first() + time_offset, size);
  best.as_is = best.correlation = Correlation(rates, gyro, 0);
  const std::ptrdiff_t most = std::min<std::ptrdiff_t>(reach / kBin, static_cast<std::ptrdiff_t>(size) / 4);
  for (std::ptrdiff_t shift = -most; shift <= most; ++shift) {
    const double correlation = Correlation(rates, gyro, shift);
    if (correlation > best.correlation) best.correlation = correlation, best.lag = shift * kBin;
  }
  return best;
}

Findings CheckClocks(const EventCensus& events, const std::vector<FlowSample>& flow,
                     const std::vector<ImuSample>& imu, Utime time_offset) {
  if (events.count() == 0 || imu.empty()) return {};
  Findings found{Span(events, imu, time_offset)};
  if (found.back().severity == Severity::kGood) found.push_back(Lag(events, imu, time_offset));
  if (found.back().check == "time-offset" && found.back().severity == Severity::kGood)
    found.back() = Turning(flow, imu, time_offset, found.back().figure);
  return found;
}

}  // namespace evit::diagnosis
