#include "tools/mapping/build_report.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "common/text/format_text.h"

namespace evit::mapping {
namespace {

double MedianSigma(const BuiltMap& built) {
  std::vector<double> sigmas;
  for (const MappedPoint& p : built.points) sigmas.push_back(p.sigma);
  if (sigmas.empty()) return 0;
  const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
  std::nth_element(sigmas.begin(), middle, sigmas.end());
  return *middle;
}

}  // namespace

std::string CannotWriteMap(const std::string& path) {
  const std::filesystem::path file(path);
  if (file.extension() != ".pcd" && file.extension() != ".ply")
    return path + ": maps are written as PCD or PLY; give a name that ends in .pcd or .ply";
  return "";
}

std::vector<std::string> NotesOn(const FrameList& list, const ReadFrames& frames) {
  std::vector<std::string> notes;
  if (list.without_pose > 0) {
    notes.push_back(std::to_string(list.without_pose) + " of " +
                    std::to_string(list.without_pose + list.frames.size()) +
                    " pictures have no pose (before, after or in a hole of the poses): left out");
  }
  if (list.stamps_ignored) {
    notes.push_back(
        "stamps of the pictures are of another time than the poses: the k-th pose is taken to be the "
        "k-th picture's");
  }
  constexpr Utime kFarApart = 60'000;  // us
  if (10 * list.between_poses > list.frames.size() && list.pose_interval > kFarApart) {
    notes.push_back(
        "poses are " + std::to_string(list.pose_interval / 1000) +
        " ms apart: between them the motion is taken to be even, which a hand's is not; poses every "
        "20 ms would do");
  }
  if (frames.mosaic) {
    notes.push_back(
        "the pictures are raw mosaics of a colour sensor (Bayer): neighbouring pixels are averaged");
  }
  if (frames.unreadable > 0) {
    notes.push_back(std::to_string(frames.unreadable) + " of " + std::to_string(frames.read) +
                    " pictures cannot be read, and are left out; the first: " + frames.first_unreadable);
  }
  if (frames.poor > 0) {
    notes.push_back(std::to_string(frames.poor) + " of " + std::to_string(frames.read) +
                    " pictures show few edges (blurred, dark, covered, or a bare wall): left out");
  }
  return notes;
}

std::string DoubtOf(const BuiltMap& built) {
  // Of the edges tried; m; of the depths that other views see (94 to 100 % of them in maps of good poses).
  constexpr double kFewFound = 0.15, kMuchMoved = 0.005, kConfirmed = 0.8;
  constexpr std::size_t kOnePart = 20;  // of the depths, that other views must see
  char text[400] = "";
  const double found = built.tried > 0 ? static_cast<double>(built.measured) / built.tried : 1;
  const double confirmed = built.ConfirmedShare();
  if (kOnePart * built.comparable() < built.measured) {
    std::snprintf(
        text, sizeof text,
        "hardly any place is in the sight of two views: nothing says whether poses and depths agree; "
        "more pictures, taken closer together, would");
  } else if (confirmed < kConfirmed) {
    std::snprintf(
        text, sizeof text,
        "only %.0f %% of the depths agree between views: poses of another recording, clock or frame, a "
        "calibration of another camera, or a scene that moves",
        100 * confirmed);
  } else if (found < kFewFound) {
    std::snprintf(text, sizeof text,
                  "only %.0f %% of the edges are found in other views at one depth: poses of another "
                  "recording, clock or "
                  "frame (the camera's, not a body's?), a calibration of another camera, or a camera that "
                  "barely moved for "
                  "how far things are",
                  100 * found);
  } else if (built.adjustment.moved_m > kMuchMoved) {
    std::snprintf(text, sizeof text,
                  "poses had to be moved by %.1f mm (median) for the views to fit each other: look at the "
                  "calibration, and at the poses' clock and frame (the camera's, not a body's?)",
                  1e3 * built.adjustment.moved_m);
  } else if (built.adjustment.rms_after_px > 0.5) {
    std::snprintf(text, sizeof text,
                  "points lie %.2f px off the edges they were made from: look at the calibration, and at the "
                  "poses' clock",
                  built.adjustment.rms_after_px);
  } else if (built.points.size() < 500) {
    std::snprintf(text, sizeof text,
                  "%zu points are few to track on: more pictures, more light, more texture, or a smaller "
                  "--contrast",
                  built.points.size());
  }
  return text;
}

PointMap MapOf(const BuiltMap& built) {
  PointMap map;
  for (const MappedPoint& p : built.points) {
    map.points.push_back(p.position.cast<float>());
    map.attributes.push_back({p.direction.cast<float>(), static_cast<float>(p.sigma),
                              static_cast<float>(p.views), static_cast<float>(p.contrast)});
  }
  return map;
}

Trajectory PosesOf(const BuiltMap& built, const std::vector<Utime>& stamps) {
  Trajectory poses;
  for (std::size_t k = 0; k < built.poses.size(); ++k) poses.push_back({stamps.at(k), built.poses[k]});
  return poses;
}

std::string SummaryOf(const std::string& path, const BuiltMap& built) {
  char text[700];
  const std::string confirmed =
      built.comparable() > 0 ? FormatText("%.0f %% confirmed by other views", 100 * built.ConfirmedShare())
                             : "none in the sight of a second view";
  std::snprintf(
      text, sizeof text,
      "%s\n"
      "  points   %zu, median sigma %.1f mm, edges about %.1f m away\n"
      "  views    %zu, of them %d key views: %zu depths of edges, %s\n"
      "  fit      points %.2f px (rms) off the edges in all views, %.2f before; poses moved by %.1f mm, "
      "%.2f deg (median)\n",
      path.c_str(), built.points.size(), 1e3 * MedianSigma(built), built.typical_depth_m, built.poses.size(),
      built.key_views, built.measured, confirmed.c_str(), built.adjustment.rms_after_px,
      built.adjustment.rms_before_px, 1e3 * built.adjustment.moved_m, built.adjustment.turned_deg);
  std::string summary = text;
  if (built.event_lag_px != 0) {
    std::snprintf(text, sizeof text, "  events   %.2f px behind their edges: put right\n",
                  built.event_lag_px);
    summary += text;
  }
  return summary;
}

}  // namespace evit::mapping
