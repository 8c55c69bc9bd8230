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

}  // namespace

void DrawText(cv::Mat* image, const std::string& text, cv::Point at, double size, Anchor anchor,
              const cv::Scalar& color, int thickness) {
  int base = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, thickness, &base);
  if (anchor == Anchor::kCenter) at.x -= extent.width / 2;
  if (anchor == Anchor::kRight) at.x -= extent.width;
  cv::putText(*image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, color, thickness, cv::LINE_AA);
}

void Chart::Draw(cv::Mat* image, const cv::Rect& where) const {
  const cv::Rect plot(where.x + 78, where.y + 36, where.width - 98, where.height - 88);
  Range rx, ry;
  for (const Series& s : series) {
    for (const double v : s.x) rx.Add(v);
    for (const double v : s.y) ry.Add(v);
  }
  rx.Pad();
  ry.Pad();
  if (from_zero) ry.low = 0;
  if (equal_axes) {
    const double scale = std::max((rx.high - rx.low) / plot.width, (ry.high - ry.low) / plot.height);
    const auto widen = [&](Range* r, int pixels) {
      const double middle = 0.5 * (r->low + r->high);
      r->low = middle - 0.5 * scale * pixels;
      r->high = middle + 0.5 * scale * pixels;
    };
    widen(&rx, plot.width);
    widen(&ry, plot.height);
  }
  const auto px = [&](double x) { return plot.x + (x - rx.low) / (rx.high - rx.low) * plot.width; };
  const auto py = [&](double y) {
    return plot.y + plot.height - (y - ry.low) / (ry.high - ry.low) * plot.height;
  };

  const double step_x = TickStep(rx.high - rx.low, std::max(2, plot.width / 105));
  const double step_y = TickStep(ry.high - ry.low, std::max(2, plot.height / 45));
  for (double v = std::ceil(rx.low / step_x) * step_x; v <= rx.high; v += step_x) {
    const int x = static_cast<int>(std::lround(px(v)));
    cv::line(*image, {x, plot.y}, {x, plot.y + plot.height}, kGrid);
    DrawText(image, TickText(v, step_x), {x, plot.y + plot.height + 20}, kTick, Anchor::kCenter);
  }
  for (double v = std::ceil(ry.low / step_y) * step_y; v <= ry.high; v += step_y) {
    const int y = static_cast<int>(std::lround(py(v)));
    cv::line(*image, {plot.x, y}, {plot.x + plot.width, y}, kGrid);
    DrawText(image, TickText(v, step_y), {plot.x - 6, y + 6}, kTick, Anchor::kRight);
  }
  cv::rectangle(*image, plot, kAxis);

  constexpr int kShift = 4;  // sub-pixel positions: curves without steps
  const auto point = [&](const Series& s, std::size_t k) {
    return cv::Point(static_cast<int>(std::lround(px(s.x[k]) * (1 << kShift))),
                     static_cast<int>(std::lround(py(s.y[k]) * (1 << kShift))));
  };
  for (const Series& s : series) {
    double length = 0;  // pixels, along the curve
    for (std::size_t k = 0; k < s.x.size(); ++k) {
      if (!s.line) {
        cv::circle(*image, point(s, k), 2 << kShift, s.color, cv::FILLED, cv::LINE_AA, kShift);
        continue;
      }
      if (k == 0 || (s.gap > 0 && s.x[k] - s.x[k - 1] > s.gap)) continue;
      const cv::Point from = point(s, k - 1), to = point(s, k);
      if (IsInk(s, length)) cv::line(*image, from, to, s.color, 2, cv::LINE_AA, kShift);
      length += cv::norm(to - from) / (1 << kShift);
    }
  }
  DrawText(image, title, {plot.x, where.y + 24}, kTitle, Anchor::kLeft);
  DrawText(image, x_label, {plot.x + plot.width / 2, plot.y + plot.height + 43}, kLabel, Anchor::kCenter);
  DrawText(image, y_label, {where.x + 6, where.y + 24}, kLabel, Anchor::kLeft);
  int x = plot.x + plot.width;
  for (auto s = series.rbegin(); s != series.rend(); ++s) {  // legend, right-aligned above the plot
    if (s->name.empty()) continue;
    int base = 0;
    x -= cv::getTextSize(s->name, cv::FONT_HERSHEY_SIMPLEX, kLabel, 1, &base).width;
    DrawText(image, s->name, {x, where.y + 24}, kLabel, Anchor::kLeft);
    const int sample = s->dash > 0 ? std::max(30, 3 * s->dash) : 30;  // pixels: shows two dashes at least
    for (int at = 0; at < sample; at += 2 * s->dash) {
      const int end = s->dash > 0 ? std::min(sample, at + s->dash) : sample;
      cv::line(*image, {x - 7 - sample + at, where.y + 19}, {x - 7 - sample + end, where.y + 19}, s->color, 3,
               cv::LINE_AA);
      if (s->dash <= 0) break;
    }
    x -= sample + 20;
  }
}

}  // namespace evit::pictures
