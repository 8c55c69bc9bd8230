#include "tools/pictures/consistency_plot.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "common/geometry/degrees.h"
#include "tools/pictures/chart.h"
#include "tools/pictures/write_picture.h"

namespace evit::pictures {
namespace {

const cv::Scalar kErrorColour(150, 50, 130), kBound(170, 170, 170);
const char* const kNames[6] = {"position x (map)",  "position y (map)",  "position z (map)",
                               "rotation x (body)", "rotation y (body)", "rotation z (body)"};

constexpr int kWidth = 1500, kLine = 28;  // pixels; of a line of the title
constexpr double kTitleSize = 0.66;       // readable at half the picture's size

// Cuts a text after commas into lines that fit into the picture.
std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines(1);
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t comma = text.find(", ", begin);
    const std::size_t end = comma == std::string::npos ? text.size() : comma + 2;
    const std::string longer = lines.back() + text.substr(begin, end - begin);
    int base = 0;
    const bool fits =
        cv::getTextSize(longer, cv::FONT_HERSHEY_SIMPLEX, kTitleSize, 1, &base).width <= kWidth - 40;
    if (fits || lines.back().empty()) {
      lines.back() = longer;
    } else {
      lines.push_back(text.substr(begin, end - begin));
    }
    begin = end;
  }
  return lines;
}

}  // namespace

void PlotConsistency(const std::string& path, const std::string& title, const Consistency& consistency,
                     const TimeAxis& time, const std::vector<Utime>& breaks) {
  const std::vector<std::string> lines = Lines(title);
  const int top = 32 + kLine * static_cast<int>(lines.size());
  cv::Mat image(top + 1070, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  for (std::size_t k = 0; k < lines.size(); ++k)
    DrawText(&image, lines[k], {kWidth / 2, 36 + kLine * static_cast<int>(k)}, kTitleSize, Anchor::kCenter);
  const auto& errors = consistency.errors;
  for (int k = 0; k < 6; ++k) {
    const double unit = k < 3 ? 100 : kDegreesPerRadian;
    Chart chart{kNames[k], "", k < 3 ? "[cm]" : "[deg]", {}, false, false};
    chart.SetTime(time);
    if (errors.empty()) chart.title += ": no ground truth";
    Series error{"error", kErrorColour, {}, {}, true, kLongestGap};
    Series above{"2 sigma", kBound, {}, {}, true, kLongestGap}, below{"", kBound, {}, {}, true, kLongestGap};
    for (const PoseError& row : errors) {
      if (std::binary_search(breaks.begin(), breaks.end(), row.t))
        for (Series* curve : {&error, &above, &below}) curve->Break();
      error.x.push_back(time.At(row.t));
      error.y.push_back(unit * row.error[k]);
      if (row.sigma[k] <= 0) continue;  // bootstrapping
      for (Series* bound : {&above, &below}) bound->x.push_back(error.x.back());
      above.y.push_back(2 * unit * row.sigma[k]);
      below.y.push_back(-2 * unit * row.sigma[k]);
    }
    chart.series = {above, below, error};
    chart.Draw(&image, {k < 3 ? 10 : 755, top + 355 * (k % 3), 735, 350});
  }
  WritePicture(path, image);
}

}  // namespace evit::pictures
