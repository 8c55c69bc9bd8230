#include "common/diagnosis/placement_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/diagnosis/excerpt_views.h"
#include "common/geometry/degrees.h"
#include "common/overlap/misplacement.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

using Kind = Misplacement::Kind;

constexpr double kCertain = 4, kLikely = 2;  // standard errors
constexpr double kLeastGain = 0.03;          // overlap, of 1
constexpr double kFound = 0.12,
                 kFoundByMany = 0.2;  // that one, or several, unknowns must reach: less chance finds

// What good calibrations leave, and the latency of pixels in dim light.
double Tolerance(Kind kind) {
  switch (kind) {
    case Kind::kTime:
      return 0.015;
    case Kind::kRotation:
      return 1 / kDegreesPerRadian;
    case Kind::kShift:
      return 0.03;
    case Kind::kCentre:
      return 4;
    default:
      return 0.02;
  }
}

struct Fit {
  Misplacement misplacement;
  std::vector<double> overlaps;  // of each view, of 1
  double overlap = 0;            // of all
  bool OneUnknown() const {
    return misplacement.kind == Kind::kTime || misplacement.kind == Kind::kScale ||
           misplacement.kind == Kind::kFocal;
  }
};

Fit Measure(const World& world, const std::vector<MapView>& views, const Misplacement& misplacement) {
  Fit fit{misplacement, {}, 0};
  MapEventOverlap sum;
  for (const MapView& view : views) {
    const MapEventOverlap one =
        MeasureCorrected(world.rig, world.truth, {view}, misplacement, WithinAPixel());
    fit.overlaps.push_back(one.kappa());
    sum.Add(one);
  }
  fit.overlap = sum.kappa();
  return fit;
}

// By how many standard errors `a` is better than `b`, view by view.
double Better(const Fit& a, const Fit& b) {
  const auto n = static_cast<double>(a.overlaps.size());
  double mean = 0, squares = 0;
  for (std::size_t k = 0; k < a.overlaps.size(); ++k) mean += (a.overlaps[k] - b.overlaps[k]) / n;
  for (std::size_t k = 0; k < a.overlaps.size(); ++k) {
    const double off = a.overlaps[k] - b.overlaps[k] - mean;
    squares += off * off;
  }
  const double error = std::sqrt(squares / (n * std::max(1.0, n - 1)));
  return mean / std::max(error, 1e-6);
}

std::string InWords(const Misplacement& m, const Rig& rig) {
  const double percent = 100 * std::abs(m.value.x());
  switch (m.kind) {
    case Kind::kTime:
      return FormatText("the camera's clock is %.0f ms off", 1e3 * m.value.x());
    case Kind::kRotation:
      return FormatText("T_body_camera is turned by %.1f degrees", kDegreesPerRadian * m.value.norm());
    case Kind::kShift:
      return FormatText("map and poses are %.0f cm apart", 100 * m.value.norm());
    case Kind::kScale:
      return FormatText("the map is %.1f %% too %s, or the poses' positions the other way round", percent,
                        m.value.x() > 0 ? "large" : "small");
    case Kind::kFocal:
      return FormatText("the focal length is %.1f %% too %s: %.1f would fit", percent,
                        m.value.x() > 0 ? "short" : "long", rig.camera.fx * (1 + m.value.x()));
    case Kind::kCentre:
      return FormatText("the principal point is off by (%.0f, %.0f) pixels", m.value.x(), m.value.y());
  }
  return "";
}

const char* CheckOf(Kind kind) {
  switch (kind) {
    case Kind::kTime:
      return "time-offset";
    case Kind::kScale:
      return "map-scale";
    case Kind::kFocal:
    case Kind::kCentre:
      return "intrinsics-fit";
    default:
      return "map-overlap";
  }
}

std::string Remedy(const Misplacement& m, const Rig& rig) {
  switch (m.kind) {
    case Kind::kTime:
      return FormatText(
          "set `time_offset_us: %.0f` in the rig file's camera, then let `evit calibrate` find it exactly",
          static_cast<double>(rig.camera_time_offset) + 1e6 * m.value.x());
    case Kind::kScale:
      return FormatText("measure a known distance in the map; `evit map import --scale %.3f` mends the map",
                        1 / (1 + m.value.x()));
    case Kind::kFocal:
    case Kind::kCentre:
      return "calibrate the camera with the lens and focus of the recording (Kalibr), and take over fx, fy, "
             "cx, cy";
    case Kind::kShift:
      return "give truth and map in one frame: `evit map import --transform`";
    default:
      return "let `evit calibrate` find the extrinsics";
  }
}

// Of those that are not clearly worse than the best: first the ones with one unknown, then the better.
std::vector<const Fit*> Candidates(const std::vector<Fit>& fits) {
  const auto best = std::max_element(fits.begin(), fits.end(),
                                     [](const Fit& a, const Fit& b) { return a.overlap < b.overlap; });
  std::vector<const Fit*> alike;
  for (const Fit& fit : fits)
    if (&fit == &*best || Better(*best, fit) < kLikely) alike.push_back(&fit);
  std::sort(alike.begin(), alike.end(), [](const Fit* a, const Fit* b) {
    return a->OneUnknown() != b->OneUnknown() ? a->OneUnknown() : a->overlap > b->overlap;
  });
  return alike;
}

Findings GoodOnes(const std::vector<Fit>& fits) {
  Findings found;
  for (const Fit& fit : fits) {
    const Kind kind = fit.misplacement.kind;
    if (kind == Kind::kScale || kind == Kind::kFocal)
      found.push_back(Good(
          CheckOf(kind), FormatText("%s fits best at %+.1f %%", kind == Kind::kScale ? "map" : "focal length",
                                    100 * fit.misplacement.value.x())));
  }
  return found;
}

}  // namespace

PlacementCheck CheckPlacement(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                              double best) {
  PlacementCheck check;
  MapViewOptions options;
  options.max_points = 1500;
  options.margin_px = 0.1 * world.rig.camera.width;  // what a scale of some percent brings into view
  const std::vector<MapView> views = ViewsOf(map, world, excerpts, 1, options);
  if (views.size() < 5 || 2 * views.size() < excerpts.instants().size()) return check;
  const Fit given = Measure(world, views, {Kind::kTime, Eigen::Vector3d::Zero(), 0});
  std::vector<Fit> fits;
  for (const Misplacement& m : FindMisplacements(world.rig, world.truth, views))
    fits.push_back(Measure(world, views, m));
  for (const Fit* fit : Candidates(fits)) {
    const Misplacement& m = fit->misplacement;
    if (m.value.norm() < Tolerance(m.kind) ||
        fit->overlap < std::max(best, fit->OneUnknown() ? kFound : kFoundByMany) ||
        fit->overlap < given.overlap + kLeastGain || Better(*fit, given) < kCertain)
      continue;
    std::string what = InWords(m, world.rig);
    what[0] = m.kind == Kind::kRotation ? what[0] : static_cast<char>(what[0] - 'a' + 'A');
    what += FormatText(": then the map lies on the events (%.2f instead of %.2f, of 1).", fit->overlap,
                       given.overlap);
    for (const Fit* other : Candidates(fits)) {
      const Misplacement& o = other->misplacement;
      if (other == fit || o.value.norm() < Tolerance(o.kind) || Better(*other, given) < kCertain) continue;
      what += " It would also fit if " + InWords(o, world.rig) + ".";
    }
    check.misplaced = true;
    check.findings = {
        {CheckOf(m.kind), given.overlap < 0.5 * fit->overlap ? Severity::kError : Severity::kWarning,
         FormatText("better by %.0f standard errors over %zu views", Better(*fit, given), views.size()), what,
         Remedy(m, world.rig)}};
    return check;
  }
  check.findings = GoodOnes(fits);
  return check;
}

}  // namespace evit::diagnosis
