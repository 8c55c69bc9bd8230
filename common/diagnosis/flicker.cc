#include "common/diagnosis/flicker.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

using MillisecondBins = std::vector<EventCensus::Bin>;

constexpr double kPi = 3.14159265358979323846;
constexpr double kFewestForFlicker = 5'000;  // that show a swing
constexpr double kFlickeringShare = 0.1;     // of the events, from the parts of the image that flicker

double CountEvents(const MillisecondBins& bins) {
  double n = 0;
  for (const EventCensus::Bin& bin : bins) n += static_cast<double>(bin.brighter) + bin.darker;
  return n;
}

// Of the share of brightening in each millisecond, not of the rate: bursts that readout or frames make have
// both polarities alike. Mean over windows of half a second, as the phase of the mains drifts.
double SwingAt(const MillisecondBins& bins, double hz) {
  constexpr std::size_t kWindow = 500;
  const std::complex<double> turn = std::polar(1.0, -2 * kPi * hz / 1e3);
  double sum = 0, all = 0;
  for (std::size_t begin = 0; begin + kWindow <= bins.size(); begin += kWindow) {
    double mean = 0, events = 0;
    for (std::size_t k = begin; k < begin + kWindow; ++k) {
      mean += static_cast<double>(bins[k].brighter) - static_cast<double>(bins[k].darker);
      events += static_cast<double>(bins[k].brighter) + static_cast<double>(bins[k].darker);
    }
    mean /= kWindow;
    std::complex<double> total = 0, phase = 1;
    for (std::size_t k = begin; k < begin + kWindow; ++k, phase *= turn)
      total += (static_cast<double>(bins[k].brighter) - static_cast<double>(bins[k].darker) - mean) * phase;
    sum += 2 * std::abs(total), all += events;
  }
  return all > 0 ? sum / all : 0;
}

// Of the frequencies around.
double Beside(const MillisecondBins& bins, double hz) {
  std::vector<double> beside;
  for (const double by : {-9.0, -7.0, -5.0, 5.0, 7.0, 9.0}) beside.push_back(SwingAt(bins, hz + by));
  std::nth_element(beside.begin(), beside.begin() + 3, beside.end());
  return beside[3];
}

// Whether the events were made from video of 30 Hz: no lamp swings at its odd multiples.
bool FromVideo(const MillisecondBins& bins) {
  return std::max(SwingAt(bins, 30) / std::max(Beside(bins, 30), 1e-6),
                  SwingAt(bins, 90) / std::max(Beside(bins, 90), 1e-6)) > 3;
}

}  // namespace

Flicker FindFlicker(const MillisecondBins& bins) {
  Flicker best;
  if (bins.size() < 1000 || CountEvents(bins) < kFewestForFlicker) return best;
  for (const double hz : {50.0, 60.0, 100.0, 120.0}) {
    const double swing = SwingAt(bins, hz), excess = swing / std::max(Beside(bins, hz), 1e-6);
    if (swing < best.swing || excess < 3) continue;
    // Events made from video swing at all multiples of its 30 Hz.
    const bool video = 2 * std::max(SwingAt(bins, hz - 30), SwingAt(bins, hz + 30)) > swing;
    if (!video) best = {hz, swing, excess};
  }
  return best;
}

Finding CheckFlicker(const EventCensus& e) {
  Flicker strongest = FindFlicker(e.bins());
  double of_all = 1;  // of the events, in the parts that flicker
  if (!strongest.Certain()) {
    const bool video = FromVideo(e.bins());
    double flickers = 0;
    Flicker part;
    for (const MillisecondBins& tile : e.tiles()) {
      const Flicker f = FindFlicker(tile);
      if (!f.Certain() || (video && (f.hz == 60 || f.hz == 120))) continue;
      flickers += CountEvents(tile);
      if (f.swing > part.swing) part = f;
    }
    of_all = flickers / std::max(1.0, CountEvents(e.bins()));
    if (of_all >= kFlickeringShare) strongest = part;
  }
  const std::string figure =
      FormatText("strongest swing %.0f %% at %.0f Hz", 100 * strongest.swing, strongest.hz);
  if (!strongest.Certain()) return Good("flicker", figure);
  return {
      "flicker", strongest.swing > 0.5 && of_all > 0.5 ? Severity::kError : Severity::kWarning, figure,
      FormatText("The light flickers at %.0f Hz: a lamp on %d Hz mains%s. It makes events on every edge, "
                 "moving or not.",
                 strongest.hz, strongest.hz == 50 || strongest.hz == 100 ? 50 : 60,
                 of_all < 1
                     ? FormatText(", in parts of the image with %.0f %% of the events", 100 * of_all).c_str()
                     : ""),
      "use daylight or lamps with direct current; else switch on the camera's anti-flicker filter"};
}

}  // namespace evit::diagnosis
