#include "tools/pictures/consistency_plot.h"

#include <algorithm>

#include "common/geometry/degrees.h"
#include "tools/pictures/chart.h"
#include "tools/pictures/write_picture.h"

namespace evit::pictures {
namespace {

constexpr double kGap = 0.3;  // s: longer ones are not bridged
const cv::Scalar kErrorColour(150, 50, 130), kBound(170, 170, 170);
const char* const kNames[6] = {"position x (map)",  "position y (map)",  "position z (map)",
                               "rotation x (body)", "rotation y (body)", "rotation z (body)"};

}  // namespace

void PlotConsistency(const std::string& path, const std::string& title, const Consistency& consistency) {
  cv::Mat image(1130, 1500, CV_8UC3, cv::Scalar(255, 255, 255));
  DrawText(&image, title, {750, 36}, std::min(0.46, 75.0 / static_cast<double>(title.size() + 1)),
           Anchor::kCenter, {20, 20, 20}, 1);
  const auto& errors = consistency.errors;
  const Utime t0 = errors.empty() ? 0 : errors.front().t;
  for (int k = 0; k < 6; ++k) {
    const double unit = k < 3 ? 100 : kDegreesPerRadian;
    Chart chart{kNames[k], "time [s]", k < 3 ? "[cm]" : "[deg]", {}, false, false};
    if (errors.empty()) chart.title += ": no ground truth";
    Series error{"error", kErrorColour, {}, {}, true, kGap};
    Series above{"2 sigma", kBound, {}, {}, true, kGap}, below{"", kBound, {}, {}, true, kGap};
    for (const PoseError& row : errors) {
      error.x.push_back(ToSeconds(row.t - t0));
      error.y.push_back(unit * row.error[k]);
      if (row.sigma[k] <= 0) continue;  // bootstrapping
      for (Series* bound : {&above, &below}) bound->x.push_back(error.x.back());
      above.y.push_back(2 * unit * row.sigma[k]);
      below.y.push_back(-2 * unit * row.sigma[k]);
    }
    chart.series = {above, below, error};
    chart.Draw(&image, {k < 3 ? 10 : 755, 60 + 355 * (k % 3), 735, 350});
  }
  WritePicture(path, image);
}

}  // namespace evit::pictures
