#include "tools/locate/search_trace.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::locate {
namespace {

constexpr double kRightM = 0.1, kRightDegrees = 3;

// "3 places followed, the best for 0.1 s" and "... 0.2 s" say the same.
std::string WithoutNumbers(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }),
             text.end());
  return text;
}

std::string SearchText(const PlaceSearch& search, const SE3& truth, double at) {
  const Eigen::Vector3d up = truth.q.conjugate() * Eigen::Vector3d::UnitZ();
  std::string text = FormatText("  at %.2f s: searched, the vertical %.1f deg off; places:", at,
                                std::acos(std::min(1.0, up.dot(search.up_body))) * kDegreesPerRadian);
  for (const PlaceCandidate& c : search.candidates)
    text += FormatText(" %.1f%s", c.significance, IsRight(c.T_map_body, truth) ? " (right)" : "");
  return text + "\n";
}

}  // namespace

bool IsRight(const SE3& pose, const SE3& truth) {
  return (pose.p - truth.p).norm() < kRightM &&
         AngularDistance(pose.q, truth.q) < kRightDegrees / kDegreesPerRadian;
}

std::string TraceText(const LocatorResult& result, const Trajectory& truth) {
  std::string text, said;
  for (const PlaceSearch& search : result.asked) {
    SE3 pose;
    if (!PoseAt(truth, search.t, &pose)) continue;
    const double at = ToSeconds(search.t - result.begin);
    if (search.everywhere) text += SearchText(search, pose, at);
    if (WithoutNumbers(search.progress) == said) continue;
    said = WithoutNumbers(search.progress);
    text += FormatText("  at %.2f s: %s\n", at, search.progress.c_str());
  }
  return text;
}

Claim AtOnce(const LocatorResult& result, const Trajectory& truth) {
  const SelfLocatorOptions rule;
  for (const PlaceSearch& search : result.asked) {
    double best = 0, second = 0;
    const PlaceCandidate* place = nullptr;
    for (const PlaceCandidate& c : search.candidates) {
      if (c.significance > best) {
        second = best, best = c.significance, place = &c;
      } else {
        second = std::max(second, c.significance);
      }
    }
    SE3 pose;
    if (best < rule.least_significance || best < second + rule.least_lead || !PoseAt(truth, search.t, &pose))
      continue;
    return IsRight(place->T_map_body, pose) ? Claim::kRight : Claim::kWrong;
  }
  return Claim::kNone;
}

}  // namespace evit::locate
