#include "common/diagnosis/flicker.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace evit::diagnosis {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

Flicker FindFlicker(const EventCensus& e) {
  Flicker best;
  const std::size_t n = e.bins().size();
  if (n < 1000 || e.count() < 10'000) return best;
  // Of the share of brightening in each millisecond, not of the rate: bursts that readout or frames make have
  // both polarities alike. Amplitudes of windows of half a second, as the phase of the mains drifts.
  const auto amplitude = [&e, n](double hz) {
    constexpr std::size_t kWindow = 500;
    double sum = 0;
    std::size_t windows = 0;
    for (std::size_t begin = 0; begin + kWindow <= n; begin += kWindow, ++windows) {
      double mean = 0, events = 0;
      for (std::size_t k = begin; k < begin + kWindow; ++k) {
        mean += static_cast<double>(e.bins()[k].brighter) - static_cast<double>(e.bins()[k].darker);
        events += static_cast<double>(e.bins()[k].brighter) + static_cast<double>(e.bins()[k].darker);
      }
      if (events < 1000) continue;
      mean /= kWindow;
      std::complex<double> total = 0;
      for (std::size_t k = begin; k < begin + kWindow; ++k) {
        const double signal =
            static_cast<double>(e.bins()[k].brighter) - static_cast<double>(e.bins()[k].darker) - mean;
        total += signal * std::polar(1.0, -2 * kPi * hz * static_cast<double>(k) / 1e3);
      }
      sum += 2 * std::abs(total) / events;
    }
    return windows > 0 ? sum / static_cast<double>(windows) : 0;
  };
  for (const double hz : {50.0, 60.0, 100.0, 120.0}) {
    std::vector<double> beside;
    for (const double by : {-9.0, -7.0, -5.0, 5.0, 7.0, 9.0}) beside.push_back(amplitude(hz + by));
    std::nth_element(beside.begin(), beside.begin() + 3, beside.end());
    const double swing = amplitude(hz), excess = swing / std::max(beside[3], 1e-6);
    // Events made from video swing at all multiples of its 30 Hz.
    const bool video = 2 * std::max(amplitude(hz - 30), amplitude(hz + 30)) > swing;
    if (swing > best.swing && excess > 3 && !video) best = {hz, swing, excess};
  }
  return best;
}

}  // namespace evit::diagnosis
