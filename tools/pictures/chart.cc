#include "tools/pictures/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace evit::pictures {
namespace {

const cv::Scalar kGrid(230, 230, 230), kAxis(120, 120, 120);
// Sizes of text: readable where the picture is shown at half its size.
constexpr double kTitle = 0.66, kLabel = 0.58, kTick = 0.54;

struct Range {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  void Add(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void Pad() {
    if (high < low) low = 0, high = 1;
    const double pad = std::max(0.05 * (high - low), 1e-3 * std::max(1.0, std::abs(high)));
    low -= pad;
    high += pad;
  }
};

// A step of 1, 2 or 5 times a power of ten that gives about `count` ticks.
double TickStep(double span, int count) {
  const double raw = span / count, base = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double k : {1.0, 2.0, 5.0}) {
    if (raw <= k * base) return k * base;
  }
  return 10 * base;
}

std::string TickText(double value, double step) {
  char text[32];
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::snprintf(text, sizeof text, "%.*f", decimals, std::abs(value) < 1e-9 * step ? 0.0 : value);
  return text;
}

// Whether a dashed curve is drawn so far from its begin.
bool IsInk(const Series& series, double length) {
  return series.dash <= 0 || std::fmod(length, 2.0 * series.dash) < series.dash;
}

// Where the chart's values lie in the image.
struct Axes {
  cv::Rect plot;  // pixels
  Range x, y;

  double X(double value) const { return plot.x + (value - x.low) / (x.high - x.low) * plot.width; }
  double Y(double value) const {
    return plot.y + plot.height - (value - y.low) / (y.high - y.low) * plot.height;
  }
};

Axes AxesOf(const Chart& chart, const cv::Rect& plot) {
  Axes axes{plot, {}, {}};
  for (const Series& s : chart.series) {
    for (const double v : s.x) axes.x.Add(v);
    for (const double v : s.y) axes.y.Add(v);
  }
  for (const double v : {chart.x_begin, chart.x_end}) axes.x.Add(v);
  axes.x.Pad();
  axes.y.Pad();
  if (chart.from_zero) axes.y.low = 0;
  if (chart.equal_axes) {
    const double scale =
        std::max((axes.x.high - axes.x.low) / plot.width, (axes.y.high - axes.y.low) / plot.height);
    const auto widen = [&](Range* r, int pixels) {
      const double middle = 0.5 * (r->low + r->high);
      r->low = middle - 0.5 * scale * pixels;
      r->high = middle + 0.5 * scale * pixels;
    };
    widen(&axes.x, plot.width);
    widen(&axes.y, plot.height);
  }
  return axes;
}

void DrawGrid(const Axes& axes, cv::Mat* image) {
  const cv::Rect& plot = axes.plot;
  const double step_x = TickStep(axes.x.high - axes.x.low, std::max(2, plot.width / 105));
  const double step_y = TickStep(axes.y.high - axes.y.low, std::max(2, plot.height / 45));
  for (double v = std::ceil(axes.x.low / step_x) * step_x; v <= axes.x.high; v += step_x) {
    const int x = static_cast<int>(std::lround(axes.X(v)));
    cv::line(*image, {x, plot.y}, {x, plot.y + plot.height}, kGrid);
    DrawText(image, TickText(v, step_x), {x, plot.y + plot.height + 20}, kTick, Anchor::kCenter);
  }
  for (double v = std::ceil(axes.y.low / step_y) * step_y; v <= axes.y.high; v += step_y) {
    const int y = static_cast<int>(std::lround(axes.Y(v)));
    cv::line(*image, {plot.x, y}, {plot.x + plot.width, y}, kGrid);
    DrawText(image, TickText(v, step_y), {plot.x - 6, y + 6}, kTick, Anchor::kRight);
  }
  cv::rectangle(*image, plot, kAxis);
}

void DrawSeries(const Series& s, const Axes& axes, cv::Mat* image) {
  constexpr int kShift = 4;  // sub-pixel positions: curves without steps
  const auto point = [&](std::size_t k) {
    return cv::Point(static_cast<int>(std::lround(axes.X(s.x[k]) * (1 << kShift))),
                     static_cast<int>(std::lround(axes.Y(s.y[k]) * (1 << kShift))));
  };
  double length = 0;  // pixels, along the curve
  for (std::size_t k = 0; k < s.x.size(); ++k) {
    if (!std::isfinite(s.x[k]) || (s.line && k > 0 && !std::isfinite(s.x[k - 1]))) continue;
    if (!s.line) {
      cv::circle(*image, point(k), 2 << kShift, s.color, cv::FILLED, cv::LINE_AA, kShift);
      continue;
    }
    if (k == 0 || (s.gap > 0 && s.x[k] - s.x[k - 1] > s.gap)) continue;
    const cv::Point from = point(k - 1), to = point(k);
    if (IsInk(s, length)) cv::line(*image, from, to, s.color, 2, cv::LINE_AA, kShift);
    length += cv::norm(to - from) / (1 << kShift);
  }
}

// Right-aligned, from `x` to the left, on the line at `y`.
void DrawLegend(const std::vector<Series>& series, int x, int y, cv::Mat* image) {
  for (auto s = series.rbegin(); s != series.rend(); ++s) {
    if (s->name.empty()) continue;
    int base = 0;
    x -= cv::getTextSize(s->name, cv::FONT_HERSHEY_SIMPLEX, kLabel, 1, &base).width;
    DrawText(image, s->name, {x, y}, kLabel, Anchor::kLeft);
    const int sample = s->dash > 0 ? std::max(30, 3 * s->dash) : 30;  // pixels: shows two dashes at least
    for (int at = 0; at < sample; at += 2 * s->dash) {
      const int end = s->dash > 0 ? std::min(sample, at + s->dash) : sample;
      cv::line(*image, {x - 7 - sample + at, y - 5}, {x - 7 - sample + end, y - 5}, s->color, 3, cv::LINE_AA);
      if (s->dash <= 0) break;
    }
    x -= sample + 20;
  }
}

}  // namespace

void DrawText(cv::Mat* image, const std::string& text, cv::Point at, double size, Anchor anchor,
              const cv::Scalar& color, int thickness) {
  int base = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, thickness, &base);
  if (anchor == Anchor::kCenter) at.x -= extent.width / 2;
  if (anchor == Anchor::kRight) at.x -= extent.width;
  cv::putText(*image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, color, thickness, cv::LINE_AA);
}

void Series::Break() {
  if (x.empty()) return;
  x.push_back(std::numeric_limits<double>::quiet_NaN());
  y.push_back(x.back());
}

void Chart::SetTime(const TimeAxis& time) {
  x_label = time.Label();
  if (time.end <= time.begin) return;
  x_begin = time.At(time.begin);
  x_end = time.At(time.end);
}

void Chart::Draw(cv::Mat* image, const cv::Rect& where) const {
  const cv::Rect plot(where.x + 78, where.y + 36, where.width - 98, where.height - 88);
  const int head = where.y + 24;  // the line of text above the plot
  const Axes axes = AxesOf(*this, plot);
  DrawGrid(axes, image);
  for (const Series& s : series) DrawSeries(s, axes, image);
  DrawText(image, title, {plot.x, head}, kTitle, Anchor::kLeft);
  DrawText(image, x_label, {plot.x + plot.width / 2, plot.y + plot.height + 43}, kLabel, Anchor::kCenter);
  DrawText(image, y_label, {where.x + 6, head}, kLabel, Anchor::kLeft);
  DrawLegend(series, plot.x + plot.width, head, image);
}

}  // namespace evit::pictures
