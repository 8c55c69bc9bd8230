#pragma once

#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/pictures/time_axis.h"

namespace evit::pictures {

/// Colours of Okabe and Ito (B, G, R), which all people can tell apart: vermillion, green, blue, purple.
inline const cv::Scalar kSafeColors[4] = {{0, 94, 213}, {115, 158, 0}, {178, 114, 0}, {167, 121, 204}};

constexpr double kLongestGap = 0.3;  // s: lines over time are broken where there is nothing for longer

/// One curve or cloud of points in a chart.
struct Series {
  std::string name;          // in the legend; empty: not listed
  cv::Scalar color;          // B, G, R
  std::vector<double> x, y;  // NaN breaks a line
  bool line = true;          // false: dots
  double gap = 0;            // lines are broken where x jumps by more than this; 0: never
  int dash = 0;              // pixels: length of dashes and of what is between them; 0: a full line

  void Break();  // what is added from here on is not joined to what is there
};

/// A chart with axes, ticks, grid, labels and legend, drawn into a rectangle of an image.
struct Chart {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  bool equal_axes = false;  // one metre is one metre both ways (top view)
  bool from_zero = false;   // the y axis begins at 0 (errors)
  // What the x axis shows at least; NaN: what the series need.
  double x_begin = std::numeric_limits<double>::quiet_NaN(), x_end = x_begin;

  /// Makes the x axis that of time.
  void SetTime(const TimeAxis& time);

  void Draw(cv::Mat* image, const cv::Rect& where) const;
};

/// Text with its left end, centre or right end at a point.
enum class Anchor { kLeft, kCenter, kRight };
void DrawText(cv::Mat* image, const std::string& text, cv::Point at, double size, Anchor anchor,
              const cv::Scalar& color = cv::Scalar(40, 40, 40), int thickness = 1);

}  // namespace evit::pictures
