#include "bench/curves.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "tools/pictures/chart.h"

namespace evit::bench {
namespace {

struct Curve {
  const char* family;    // of the rows
  const char* argument;  // in the rows' names, before ':'
  double unit;           // the argument times this is x
  const char* file;
  const char* title;
  const char* x_label;
};

constexpr Curve kCurves[] = {
    {"event rate", "100 kev/s", 0.1, "event_rate", "frame_builder: a second of data", "million events/s"},
    {"resolution", "lines", 1, "resolution", "frame_builder: a second of 20 million events",
     "lines of the sensor"},
    {"map size", "1000 points", 0.001, "map_size", "map_server: one query", "million points"},
    {"window", "keyframes", 1, "window_keyframes", "solve, 1000 points each", "keyframes"},
    {"window", "points", 1, "window_points", "solve, 5 keyframes", "points per keyframe"}};

// The number after "NAME:" in a row's name; negative where there is none.
double Argument(const std::string& name, const std::string& argument) {
  const auto at = name.find("/" + argument + ":");
  return at == std::string::npos ? -1 : std::atof(name.c_str() + at + argument.size() + 2);
}

// Rows of the other argument's sweep do not belong to this curve.
bool OfThisSweep(const std::string& name, const Curve& curve) {
  if (std::string(curve.family) != "window") return true;
  return std::string(curve.argument) == "keyframes" ? Argument(name, "points") == 1000
                                                    : Argument(name, "keyframes") == 5;
}

}  // namespace

void WriteCurves(const Results& results, const std::string& folder) {
  std::filesystem::create_directories(folder);
  cv::Mat image(1350, 1300, CV_8UC3, cv::Scalar::all(255));
  int place = 0;
  for (const Curve& curve : kCurves) {
    std::map<double, double> points;  // x, ms
    for (const nlohmann::json& row : results.rows) {
      const std::string name = row["name"];
      if (name.rfind(std::string("Scaling, ") + curve.family, 0) != 0) continue;
      const double x = Argument(name, curve.argument);
      if (x >= 0 && OfThisSweep(name, curve)) points[x * curve.unit] = 1e3 * Seconds(row);
    }
    if (points.empty()) throw std::runtime_error(std::string("no rows of \"Scaling, ") + curve.family + "\"");
    std::string csv = std::string(curve.x_label) + ",ms\n";
    pictures::Series measured{"measured", cv::Scalar(180, 90, 20), {}, {}}, dots = measured;
    pictures::Series linear{"linear", cv::Scalar(160, 160, 160), {}, {}};
    dots.name.clear();
    dots.line = false;
    const auto [last_x, last_y] = *points.rbegin();
    for (const auto& [x, y] : points) {
      csv += std::to_string(x) + "," + std::to_string(y) + "\n";
      measured.x.push_back(x), measured.y.push_back(y);
      linear.x.push_back(x), linear.y.push_back(last_y * x / last_x);
    }
    dots.x = measured.x, dots.y = measured.y;
    WriteText(folder + "/" + curve.file + ".csv", csv);
    pictures::Chart chart;
    chart.title = curve.title;
    chart.x_label = curve.x_label;
    chart.y_label = "ms";
    chart.series = {linear, measured, dots};
    chart.from_zero = true;
    chart.Draw(&image, cv::Rect(place % 2 * 650, place / 2 * 450, 650, 450));
    ++place;
  }
  if (!cv::imwrite(folder + "/scaling.png", image)) {
    throw std::runtime_error(folder + "/scaling.png: cannot be written");
  }
}

}  // namespace evit::bench
