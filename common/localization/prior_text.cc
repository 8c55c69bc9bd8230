#include "common/localization/prior_text.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit {
namespace {

// `count` finite numbers, separated by `separator`, and nothing else.
std::vector<double> Numbers(const std::string& option, const std::string& text, char separator,
                            std::size_t count, const char* expected) {
  std::string spaced = text;
  if (separator != ' ') {
    for (char& c : spaced) c = c == separator ? ' ' : c;
  }
  std::istringstream in(spaced);
  std::vector<double> numbers;
  for (double value; in >> value && std::isfinite(value);) numbers.push_back(value);
  if (numbers.size() != count || !in.eof())
    throw std::runtime_error(option + " \"" + text + "\": expected \"" + expected + "\"");
  return numbers;
}

}  // namespace

PlacePrior ParsePlacePrior(const std::string& near, const std::string& height, const std::string& yaw) {
  PlacePrior prior;
  if (!near.empty()) {
    const std::vector<double> n = Numbers("--near", near, ' ', 4, "x y z radius");
    if (n[3] <= 0) throw std::runtime_error("--near \"" + near + "\": expected a radius above 0 m");
    prior.near = {{n[0], n[1], n[2]}, n[3]};
  }
  if (!height.empty()) {
    const std::vector<double> n = Numbers("--height", height, ':', 2, "low:high");
    if (n[0] >= n[1]) throw std::runtime_error("--height \"" + height + "\": expected low below high, in m");
    prior.height = {n[0], n[1]};
  }
  if (!yaw.empty()) {
    const std::vector<double> n = Numbers("--yaw", yaw, ':', 2, "degrees:tolerance");
    if (n[1] <= 0) throw std::runtime_error("--yaw \"" + yaw + "\": expected a tolerance above 0 degrees");
    prior.heading = {n[0] * kRadiansPerDegree, n[1] * kRadiansPerDegree};
  }
  return prior;
}

std::string PriorText(const PlacePrior& prior) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (prior.near) {
    const Eigen::Vector3d& p = prior.near->position;
    add(FormatText("within %.2g m of (%.2f, %.2f, %.2f)", prior.near->radius, p.x(), p.y(), p.z()));
  }
  if (prior.height) add(FormatText("between %.2f and %.2f m high", prior.height->low, prior.height->high));
  if (prior.heading) {
    add(FormatText("at a yaw of %.0f +- %.0f deg", kDegreesPerRadian * prior.heading->yaw,
                   kDegreesPerRadian * prior.heading->tolerance));
  }
  return text;
}

}  // namespace evit
