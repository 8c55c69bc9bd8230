#include "common/diagnosis/placement_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/diagnosis/placement_fit.h"
#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

using Kind = Misplacement::Kind;

constexpr double kCertain = 4, kLikely = 2;  // standard errors
constexpr double kLeastGain = 0.03;          // overlap, of 1
constexpr double kFound = 0.12,
                 kFoundByMany = 0.2;  // that one, or several, unknowns must reach: less chance finds

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
      return FormatText(
          "measure a known distance in the map; `evit map import MAP --scale %.3f --out mended.pcd` mends it",
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

bool Within(const Misplacement& m) { return m.value.norm() < Tolerance(m.kind); }

// Of those that are not clearly worse than the best: first the ones with one unknown, then the better.
std::vector<const PlacementFit*> Alike(const std::vector<PlacementFit>& fits) {
  const auto best =
      std::max_element(fits.begin(), fits.end(),
                       [](const PlacementFit& a, const PlacementFit& b) { return a.overlap < b.overlap; });
  std::vector<const PlacementFit*> alike;
  for (const PlacementFit& fit : fits)
    if (&fit == &*best || Better(*best, fit) < kLikely) alike.push_back(&fit);
  std::sort(alike.begin(), alike.end(), [](const PlacementFit* a, const PlacementFit* b) {
    return a->OneUnknown() != b->OneUnknown() ? a->OneUnknown() : a->overlap > b->overlap;
  });
  return alike;
}

Findings GoodOnes(const std::vector<PlacementFit>& fits) {
  Findings found;
  for (const PlacementFit& fit : fits) {
    const Kind kind = fit.misplacement.kind;
    if (kind == Kind::kScale || kind == Kind::kFocal)
      found.push_back(Good(
          CheckOf(kind), FormatText("%s fits best at %+.1f %%", kind == Kind::kScale ? "map" : "focal length",
                                    100 * fit.misplacement.value.x())));
  }
  return found;
}

// The first of those that fit alike; the others are mentioned.
Finding Misplaced(const std::vector<const PlacementFit*>& alike, const PlacementFit& given, const Rig& rig) {
  const PlacementFit& fit = *alike.front();
  const Misplacement& m = fit.misplacement;
  std::string what = InWords(m, rig);
  what[0] = m.kind == Kind::kRotation ? what[0] : static_cast<char>(what[0] - 'a' + 'A');
  what += FormatText(": then the map lies on the events (%.2f instead of %.2f, of 1).", fit.overlap,
                     given.overlap);
  for (const PlacementFit* other : alike)
    if (other != &fit) what += " It would also fit if " + InWords(other->misplacement, rig) + ".";
  return {
      CheckOf(m.kind), given.overlap < 0.5 * fit.overlap ? Severity::kError : Severity::kWarning,
      FormatText("better by %.0f standard errors over %zu views", Better(fit, given), given.overlaps.size()),
      what, Remedy(m, rig)};
}

}  // namespace

PlacementCheck CheckPlacement(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                              double best) {
  PlacementCheck check;
  const std::vector<MapView> views = PlacementViews(map, world, excerpts);
  std::vector<PlacementFit> fits;
  const PlacementFit given = MeasurePlacement(world, views, {});
  if (EnoughViews(views, excerpts))
    for (const Misplacement& m : FindMisplacements(world.rig, world.truth, views))
      fits.push_back(MeasurePlacement(world, views, m));
  if (given.overlap < kFound)
    if (std::optional<PlacementFit> far = FindFarScale(map, world, excerpts)) fits.push_back(std::move(*far));
  if (fits.empty()) return check;
  const auto counts = [&](const PlacementFit& fit) {
    return !Within(fit.misplacement) &&
           fit.overlap >= std::max(best, fit.OneUnknown() ? kFound : kFoundByMany) &&
           fit.overlap >= given.overlap + kLeastGain && Better(fit, given) >= kCertain;
  };
  const std::vector<const PlacementFit*> alike = Alike(fits);
  check.misplaced =
      std::any_of(alike.begin(), alike.end(), [&](const PlacementFit* f) { return counts(*f); });
  if (!check.misplaced) {
    check.findings = GoodOnes(fits);
    return check;
  }
  std::vector<PlacementFit> refined;
  for (const PlacementFit& fit : fits)
    if (counts(fit)) refined.push_back(Refined(map, world, excerpts, fit));
  const std::vector<const PlacementFit*> named = Alike(refined);
  check.overlap = named.front()->overlap;
  check.findings = {Misplaced(named, given, world.rig)};
  return check;
}

}  // namespace evit::diagnosis
