#include "tools/mapping/check_findings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/geometry/degrees.h"

namespace evit::mapping {
namespace {

using Kind = Misplacement::Kind;

template <typename... Values>
std::string Text(const char* format, Values... values) {
  char text[800];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Share of the pixels that fired that lie on a good map, on recordings that are tracked to within a
// centimetre (docs/results/accuracy.md): also noise, weak edges and what the map leaves out fire.
constexpr double kUsualLow = 0.38, kUsualHigh = 0.75;
constexpr double kLeastKappa = 0.1, kLeastEventKappa = 0.05;  // beyond chance; less is none
constexpr double kUsuallySeen = 0.5, kHardlySeen = 0.2;       // of the moments, a map in view
constexpr double kUprightDeg = 2, kFallenDeg = 10;            // the second: gravity pulls a tracker off

// Of two that fit alike, the one with fewer unknowns is more likely.
double Merit(const Misplacement& fit) {
  const bool three = fit.kind == Kind::kRotation || fit.kind == Kind::kShift;
  return fit.point_share - 0.005 * (three ? 3 : (fit.kind == Kind::kCentre ? 2 : 1));
}

std::string Remedy(const MapCheckInputs& inputs, const Misplacement& fit) {
  const Eigen::Vector3d& v = fit.value;
  switch (fit.kind) {
    case Kind::kTime:
      return Text("add %.0f to camera.time_offset_us of ", 1e6 * v.x()) + inputs.rig +
             ", or let evit calibrate find it";
    case Kind::kRotation:
      return "T_body_camera of " + inputs.rig + " is off: evit calibrate finds it";
    case Kind::kShift:
      return Text(
          "the map's frame is not that of the poses: evit map transform --transform \"1 0 0 %.4f 0 1 0 "
          "%.4f 0 0 1 %.4f 0 0 0 1\"",
          -v.x(), -v.y(), -v.z());
    case Kind::kScale:
      return Text("evit map transform --scale %.4f, and look where the poses' scale comes from",
                  1 / (1 + v.x()));
    case Kind::kFocal:
      return "fx and fy of " + inputs.rig + " are another camera's, or another image size's";
    case Kind::kCentre:
      return "cx and cy of " + inputs.rig + " are another camera's, or another image size's";
  }
  return "";
}

// Whether a map has to do with what fires. Of 24 good maps, made of pictures, depth or events, real and
// simulated, 32 to 88 % of the points and 24 to 52 % of the pixels lie where they should beyond chance; of
// maps of other rooms at most 2 and 1 %.
bool Explains(const MapEventOverlap& overlap) {
  return overlap.kappa() >= kLeastKappa && overlap.event_kappa() >= kLeastEventKappa;
}

std::string MisplacedText(const MapCheckInputs& inputs, const MapCheck& check) {
  const Misplacement& best = check.fits.front();
  std::string text = Describe(best) +
                     Text(": corrected, %.0f %% of the points lie on events instead of %.0f %%; ",
                          100 * best.point_share, 100 * check.point_share) +
                     Remedy(inputs, best);
  for (std::size_t k = 1; k < check.fits.size(); ++k) {
    const Misplacement& fit = check.fits[k];
    // Nearly as good: which of them it is, these events cannot tell.
    if (fit.point_share - check.point_share < 0.8 * (best.point_share - check.point_share)) break;
    text += "; nearly as likely: " + Describe(fit);
  }
  return text;
}

std::string UnrelatedText(const MapCheckInputs& inputs, const MapCheck& check) {
  const MapEventOverlap& o = check.overlap;
  return Text(
             "map and events have almost nothing to do with each other (%.0f %% of the points on events, "
             "%.0f %% by chance; %.0f %% of the pixels that fire on the map, %.0f %% by chance): another "
             "room's "
             "map, a map of little of what is seen, another frame (are the poses the body's, not a marker's? "
             "is y up in "
             "the "
             "map: evit map transform --transform \"1 0 0 0 0 0 -1 0 0 1 0 0 0 0 0 1\") or unit: evit map "
             "info ",
             100 * o.point_share(), 100 * o.point_share_by_chance(), 100 * o.event_share(),
             100 * o.event_share_by_chance()) +
         inputs.map;
}

std::string UsualText(double event_share) {
  const char* verdict = event_share < kUsualLow ? "fewer than usual" : "as usual";
  if (event_share > kUsualHigh) verdict = "more than usual";
  return Text("%s (%.0f to %.0f %%)", verdict, 100 * kUsualLow, 100 * kUsualHigh);
}

}  // namespace

std::string Describe(const Misplacement& fit) {
  const Eigen::Vector3d& v = fit.value;
  switch (fit.kind) {
    case Kind::kTime:
      return Text("events %.1f ms %s", 1e3 * std::abs(v.x()), v.x() < 0 ? "late" : "early");
    case Kind::kRotation:
      return Text("camera turned by %.2f deg (x %.2f, y %.2f, z %.2f)", kDegreesPerRadian * v.norm(),
                  kDegreesPerRadian * v.x(), kDegreesPerRadian * v.y(), kDegreesPerRadian * v.z());
    case Kind::kShift:
      return Text("poses shifted by %.1f cm (%.3f %.3f %.3f m)", 100 * v.norm(), v.x(), v.y(), v.z());
    case Kind::kScale:
      return Text("poses %.1f %% too %s for the map", 100 * std::abs(v.x()), v.x() > 0 ? "small" : "large");
    case Kind::kFocal:
      return Text("focal length %.1f %% too %s", 100 * std::abs(v.x()), v.x() > 0 ? "short" : "long");
    case Kind::kCentre:
      return Text("principal point off by %.1f, %.1f px", -v.x(), -v.y());
  }
  return "";
}

bool IsWorthAWord(const Misplacement& fit, double share_as_is) {
  // As much as a seventh of the points that are off: few are where the camera moves slowly, though all is
  // wrong.
  if (fit.point_share < share_as_is + std::max(0.02, 0.15 * (1 - share_as_is))) return false;
  switch (fit.kind) {
    case Kind::kTime:
      return std::abs(fit.value.x()) > 0.003;
    case Kind::kRotation:
      return fit.value.norm() * kDegreesPerRadian > 0.2;
    case Kind::kShift:
      return fit.value.norm() > 0.008;
    case Kind::kCentre:
      return fit.value.norm() > 1.5;
    default:
      return std::abs(fit.value.x()) > 0.01;
  }
}

void SortByMerit(std::vector<Misplacement>* fits) {
  std::stable_sort(fits->begin(), fits->end(),
                   [](const Misplacement& a, const Misplacement& b) { return Merit(a) > Merit(b); });
}

std::vector<CheckFinding> Findings(const MapCheckInputs& inputs, const MapCheck& check) {
  std::vector<CheckFinding> findings;
  const bool fits = Explains(check.overlap);
  // Another placement counts where it explains what fires, not only where some points happen to lie on it.
  const bool misplaced =
      !check.fits.empty() && IsWorthAWord(check.fits.front(), check.point_share) && Explains(check.corrected);
  if (misplaced) {
    findings.push_back({!fits, MisplacedText(inputs, check)});
  } else if (!fits) {
    findings.push_back({true, UnrelatedText(inputs, check)});
  }
  const auto seen = static_cast<double>(check.views.size());
  const double planned = std::max(seen, static_cast<double>(check.moments_planned));
  if (seen < kUsuallySeen * planned) {
    findings.push_back(
        {seen < kHardlySeen * planned,
         Text(
             "the map is in view at only %.0f of %.0f moments: it is of another place, or of a small part of "
             "this one (evit map merge with maps of the rest, evit map build of all pictures)",
             seen, planned)});
  }
  if (check.has_imu && check.tilt_deg > kUprightDeg) {
    findings.push_back(
        {check.tilt_deg > kFallenDeg,
         Text("gravity is %.1f deg off -z of the map: the map is not upright (evit map transform --upright ",
              check.tilt_deg) +
             inputs.log + " --truth " + inputs.truth + "), or the poses are not the IMU's (T_marker_body)"});
  }
  if (!misplaced && fits && check.overlap.event_share() < kUsualLow) {
    findings.push_back(
        {false,
         Text("only %.0f %% of the pixels that fire are on the map, with good maps %.0f to %.0f %% are: "
              "it has holes, or things move; more pictures or a smaller --contrast for evit map build, "
              "or evit map merge with another map",
              100 * check.overlap.event_share(), 100 * kUsualLow, 100 * kUsualHigh)});
  }
  if (check.cells_seen > 0 && 2 * check.cells_silent > check.cells_seen) {
    findings.push_back(
        {false,
         Text("%.0f %% of the map that was in view five times never fired: edges too weak for this "
              "camera (a larger --contrast for evit map build), or things that are gone (evit map crop)",
              100.0 * static_cast<double>(check.cells_silent) / static_cast<double>(check.cells_seen))});
  }
  std::stable_partition(findings.begin(), findings.end(), [](const CheckFinding& f) { return f.is_error; });
  return findings;
}

std::string CheckText(const MapCheckInputs& inputs, const MapCheck& check) {
  const MapEventOverlap& o = check.overlap;
  double low = 1, high = 0;
  for (const MapEventOverlap& m : check.moments) {
    low = std::min(low, m.event_share());
    high = std::max(high, m.event_share());
  }
  std::string text =
      inputs.map + " on the events of " + inputs.log + "\n" +
      Text("  points on events   %.1f %% within 2 px (%.1f %% by chance), of %.0f a view\n",
           100 * o.point_share(), 100 * o.point_share_by_chance(),
           static_cast<double>(o.points) / static_cast<double>(std::max<std::int64_t>(1, o.views))) +
      Text(
          "  events on the map  %.1f %% of the pixels that fired (%.1f %% by chance); view by view %.0f to "
          "%.0f %%, %lld views; %s\n",
          100 * o.event_share(), 100 * o.event_share_by_chance(), 100 * low, 100 * high,
          static_cast<long long>(o.views), UsualText(o.event_share()).c_str()) +
      Text("  mean offset        x %.2f, y %.2f px, from points to their events\n", o.mean_offset().x(),
           o.mean_offset().y()) +
      Text("  never fired        %zu of %zu cells of 5 cm that were in view five times (%zu in all)\n",
           check.cells_silent, check.cells_seen, check.cells);
  if (check.has_imu) text += Text("  gravity            %.1f deg off -z of the map\n", check.tilt_deg);
  text +=
      Text("  what would fit better (%.1f %% of the points on events as it is):\n", 100 * check.point_share);
  std::size_t better = 0;
  for (const Misplacement& fit : check.fits) {
    if (fit.value.isZero()) continue;
    ++better;
    text += Text("    %5.1f %%  ", 100 * fit.point_share) + Describe(fit) + "\n";
  }
  if (better < check.fits.size()) text += better == 0 ? "    nothing\n" : "    no change of another kind\n";
  if (check.findings.empty()) text += "nothing looks wrong\n";
  for (const CheckFinding& f : check.findings)
    text += std::string(f.is_error ? "error: " : "warning: ") + f.text + "\n";
  return text;
}

}  // namespace evit::mapping
