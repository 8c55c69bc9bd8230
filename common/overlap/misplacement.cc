#include "common/overlap/misplacement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace evit {
namespace {

using Kind = Misplacement::Kind;

constexpr double kLeastGain = 0.004;        // of the score, 0..1, that makes a correction one
constexpr std::size_t kFewestPoints = 300;  // points in view of all views together: by fewer nothing is told

int Unknowns(Kind kind) {
  if (kind == Kind::kCentre) return 2;
  return kind == Kind::kRotation || kind == Kind::kShift ? 3 : 1;
}

// Steps of derivatives, and of the starts.
double Small(Kind kind) {
  if (kind == Kind::kCentre) return 0.5;
  return kind == Kind::kTime || kind == Kind::kShift ? 1e-3 : 5e-4;
}
double Large(Kind kind) {
  switch (kind) {
    case Kind::kTime:
    case Kind::kRotation:
      return 0.02;
    case Kind::kShift:
      return 0.03;
    case Kind::kCentre:
      return 6;
    default:
      return 0.04;
  }
}

// The camera at a view, with the correction made.
struct Placed {
  Camera camera;
  SE3 T_map_camera;
};

Placed Place(const Rig& rig, const Trajectory& body, const MapView& view, Kind kind,
             const Eigen::Vector3d& value) {
  Placed placed{rig.camera, view.T_map_body * rig.T_body_camera};
  switch (kind) {
    case Kind::kTime: {
      SE3 moved;
      const auto off = static_cast<Utime>(std::llround(value.x() * 1e6));
      if (off != 0 && PoseAt(body, view.utime + off, &moved)) placed.T_map_camera = moved * rig.T_body_camera;
      break;
    }
    case Kind::kRotation:
      placed.T_map_camera.q = (placed.T_map_camera.q * ExpSO3(value)).normalized();
      break;
    case Kind::kShift:
      placed.T_map_camera.p += value;
      break;
    case Kind::kScale:
      placed.T_map_camera.p *= 1 + value.x();
      break;
    case Kind::kFocal:
      placed.camera.fx *= 1 + value.x();
      placed.camera.fy *= 1 + value.x();
      break;
    case Kind::kCentre:
      placed.camera.cx += value.x();
      placed.camera.cy += value.y();
      break;
  }
  return placed;
}

bool PixelIn(const Placed& placed, const SE3& T_camera_map, const Eigen::Vector3f& p,
             Eigen::Vector2d* pixel) {
  return placed.camera.Project(T_camera_map * p.cast<double>(), pixel);
}

class Fitter {
 public:
  Fitter(const Rig& rig, const Trajectory& body, const std::vector<MapView>& views,
         const MisplacementOptions& options)
      : rig_(rig), body_(body), options_(options), near_(options.radius_px), reach_(options.reach_px) {
    const std::size_t stride = 1 + views.size() / static_cast<std::size_t>(options.max_views);
    for (std::size_t k = stride / 2; k < views.size(); k += stride) views_.push_back(&views[k]);
  }

  // How well the points lie on events: share within the radius, and, for the fits, a score that also knows
  // nearer from near.
  struct Fitness {
    double share = 0, score = 0;
  };
  Fitness At(Kind kind, const Eigen::Vector3d& value) const {
    std::size_t n = 0, on = 0;
    double score = 0;
    for (const MapView* view : views_) {
      const Placed placed = Place(rig_, body_, *view, kind, value);
      const SE3 T = placed.T_map_camera.Inverse();
      for (std::size_t k = 0; k < view->points.size(); k += Stride(*view)) {
        Eigen::Vector2d pixel, offset;
        if (!PixelIn(placed, T, view->points[k], &pixel) || !placed.camera.Contains(pixel, 4)) continue;
        ++n;
        if (!near_.Find(view->fired, pixel, &offset)) continue;
        ++on;
        score += 1 / (1 + offset.squaredNorm());
      }
    }
    if (n < kFewestPoints) return {};
    return {static_cast<double>(on) / static_cast<double>(n), score / static_cast<double>(n)};
  }

  Misplacement Fit(Kind kind) const {
    Eigen::Vector3d value = Eigen::Vector3d::Zero(), best_value = value;
    Fitness best = At(kind, value);
    const auto offer = [&](const Eigen::Vector3d& candidate) {
      const Fitness fitness = At(kind, candidate);
      if (fitness.score > best.score) best = fitness, best_value = candidate;
    };
    for (int axis = 0; axis < Unknowns(kind); ++axis) {
      for (const double step : {-4.0, -2.0, -1.0, 1.0, 2.0, 4.0})
        offer(step * Large(kind) * Eigen::Vector3d::Unit(axis));
    }
    value = best_value;
    for (int k = 0; k < options_.iterations; ++k) {
      value += Step(kind, value);
      offer(value);
    }
    // Where the best value is hardly better than zero, noise has chosen it: then the answer is zero.
    const Fitness none = At(kind, Eigen::Vector3d::Zero());
    if (best.score < none.score + kLeastGain) return {kind, Eigen::Vector3d::Zero(), none.share};
    return {kind, best_value, best.share};
  }

 private:
  std::size_t Stride(const MapView& view) const {
    return 1 + view.points.size() / static_cast<std::size_t>(options_.max_points);
  }

  // One Gauss-Newton step, with derivatives by small differences.
  Eigen::Vector3d Step(Kind kind, const Eigen::Vector3d& value) const {
    const int n = Unknowns(kind);
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity() * 1e-6;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (const MapView* view : views_) {
      const Placed placed = Place(rig_, body_, *view, kind, value);
      const SE3 T = placed.T_map_camera.Inverse();
      Placed moved[3];
      SE3 T_moved[3];
      for (int axis = 0; axis < n; ++axis) {
        moved[axis] = Place(rig_, body_, *view, kind, value + Small(kind) * Eigen::Vector3d::Unit(axis));
        T_moved[axis] = moved[axis].T_map_camera.Inverse();
      }
      for (std::size_t k = 0; k < view->points.size(); k += Stride(*view)) {
        Eigen::Vector2d pixel, offset;
        if (!PixelIn(placed, T, view->points[k], &pixel) || !placed.camera.Contains(pixel, 4) ||
            !reach_.Find(view->fired, pixel, &offset))
          continue;
        Eigen::Matrix<double, 2, 3> j = Eigen::Matrix<double, 2, 3>::Zero();
        for (int axis = 0; axis < n; ++axis) {
          Eigen::Vector2d to;
          if (PixelIn(moved[axis], T_moved[axis], view->points[k], &to))
            j.col(axis) = (to - pixel) / Small(kind);
        }
        // The nearest pixel lies across the edge: along it nothing is known, and where a point is on its
        // event already not even which way is across. Those would hold the others back.
        const double distance = offset.norm();
        const double w = distance > 0.75 ? 1 / (1 + distance * distance / 16) : 0.1;
        if (distance > 0.75) {
          const Eigen::Vector2d across = offset / distance;
          j = across * (across.transpose() * j);
        }
        information += w * j.transpose() * j;
        gradient += w * j.transpose() * offset;
      }
    }
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    step.head(n) = information.topLeftCorner(n, n).ldlt().solve(gradient.head(n));
    const double limit = Large(kind);
    return step.allFinite() ? Eigen::Vector3d(step.cwiseMax(-limit).cwiseMin(limit))
                            : Eigen::Vector3d::Zero();
  }

  const Rig& rig_;
  const Trajectory& body_;
  MisplacementOptions options_;
  NearestPixel near_, reach_;
  std::vector<const MapView*> views_;
};

}  // namespace

double PointShare(const Rig& rig, const Trajectory& body, const std::vector<MapView>& views,
                  const MisplacementOptions& options) {
  return Fitter(rig, body, views, options).At(Kind::kTime, Eigen::Vector3d::Zero()).share;
}

std::vector<Misplacement> FindMisplacements(const Rig& rig, const Trajectory& body,
                                            const std::vector<MapView>& views,
                                            const MisplacementOptions& options) {
  const Fitter fitter(rig, body, views, options);
  std::vector<Misplacement> found;
  for (const Kind kind :
       {Kind::kTime, Kind::kRotation, Kind::kShift, Kind::kScale, Kind::kFocal, Kind::kCentre})
    found.push_back(fitter.Fit(kind));
  return found;
}

Misplacement FindMisplacement(const Rig& rig, const Trajectory& body, const std::vector<MapView>& views,
                              Kind kind, const MisplacementOptions& options) {
  return Fitter(rig, body, views, options).Fit(kind);
}

// As Place() does for one view.
void Correct(const Misplacement& misplacement, Rig* rig, Trajectory* body) {
  const Eigen::Vector3d& value = misplacement.value;
  switch (misplacement.kind) {
    case Kind::kTime:
      rig->camera_time_offset += std::llround(1e6 * value.x());
      break;
    case Kind::kRotation:
      rig->T_body_camera.q = (rig->T_body_camera.q * ExpSO3(value)).normalized();
      break;
    case Kind::kShift:
      for (StampedPose& s : *body) s.pose.p += value;
      break;
    case Kind::kScale:
      for (StampedPose& s : *body) s.pose.p *= 1 + value.x();
      break;
    case Kind::kFocal:
      rig->camera.fx *= 1 + value.x(), rig->camera.fy *= 1 + value.x();
      break;
    case Kind::kCentre:
      rig->camera.cx += value.x(), rig->camera.cy += value.y();
      break;
  }
}

Misplacement Together(const Misplacement& a, const Misplacement& b) {
  Misplacement sum = a;
  if (a.kind == Kind::kRotation) {
    sum.value = LogSO3(ExpSO3(a.value) * ExpSO3(b.value));
  } else if (a.kind == Kind::kScale || a.kind == Kind::kFocal) {
    sum.value.x() = (1 + a.value.x()) * (1 + b.value.x()) - 1;
  } else {
    sum.value += b.value;
  }
  return sum;
}

MapEventOverlap MeasureCorrected(const Rig& rig, const Trajectory& body, const std::vector<MapView>& views,
                                 const Misplacement& misplacement, const OverlapOptions& options) {
  MapEventOverlap overlap;
  for (const MapView& view : views) {
    const Placed placed = Place(rig, body, view, misplacement.kind, misplacement.value);
    overlap.Add(MeasureOverlap(placed.camera, placed.T_map_camera, view, options));
  }
  return overlap;
}

}  // namespace evit
