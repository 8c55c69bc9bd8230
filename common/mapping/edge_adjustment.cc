#include "common/mapping/edge_adjustment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/geometry/degrees.h"
#include "common/map/occlusion.h"
#include "common/parallel/parallel_for.h"

namespace evit {
namespace {

constexpr double kKernelPx = 0.7;
constexpr double kInlierPx = 1.0;
constexpr int kBorderPx = 6;
constexpr std::size_t kPointsPerPose = 2500;
constexpr int kViewsPerPoint = 150;  // about, while points are on their way
// What is left of a direction where it is turned, nearly the cosine of the angle: less, and the views do not
// show one line.
constexpr double kOneLine = 0.8;
constexpr double kAlike = 5;  // points on one edge err together: so many of them are worth one

// A point's distance to the edge it is seen as, across, and its derivative by the point in the camera frame.
struct Sighting {
  bool found = false;
  double off = 0;  // pixels
  int way = 0;     // that its edge goes, see CameraSweep
  Eigen::RowVector3d by_point = Eigen::RowVector3d::Zero();

  double Weight() const { return 1 / (1 + off * off / (kKernelPx * kKernelPx)); }
};

// False where the point is not to be expected in the picture, or points at the camera.
bool Look(const PinholeView& pinhole, const PosedEdges& view, const MappedPoint& point,
          const Eigen::Vector3d& p, double radius, Sighting* sighting) {
  const Eigen::Matrix<double, 2, 3> jacobian = pinhole.Jacobian(p);
  const Eigen::Vector2d tangent = jacobian * (pinhole.R * point.direction);
  const double length = tangent.norm();
  if (length < 0.25 * pinhole.camera.fx / p.z()) return false;
  EdgeImage::Query query;
  const Eigen::Vector2d pixel = pinhole.Pixel(p);
  query.pixel = pixel.cast<float>();
  query.normal = (Eigen::Vector2d(-tangent.y(), tangent.x()) / length).cast<float>();
  query.radius = static_cast<float>(radius);
  if (!view.sweep.Shows(pinhole.camera, p, query.normal)) return false;
  sighting->found = false;
  if (const EdgePixel* match = view.edges.Match(query)) {
    const Eigen::RowVector2d normal = match->normal.cast<double>().transpose();
    sighting->found = true;
    sighting->way = view.sweep.Way(pinhole.camera, p, query.normal);
    sighting->off = normal * (pixel - match->pixel.cast<double>()) - point.lag * sighting->way;
    sighting->by_point = normal * jacobian;
  }
  return true;
}

// How many of so many views count as independent: poses' errors do not average out over neighbouring ones.
double Independent(double seen) { return seen / std::max(1.0, std::min(10.0, seen / 3)); }

// Each view's edge and the camera span a plane that holds the line: seen from different places, these planes
// tell how it slants, which its neighbours' depths tell badly where it is short and far. With a wrong slant,
// what a point's depth is off would seem to be along its line, and of no account. `information`: about the
// point's position, of the views (m^-2).
void AlignWithViews(const Eigen::Matrix3d& information, double independent,
                    const EdgeAdjustmentOptions& options, Eigen::Vector3d* direction) {
  const double trace = information.trace();
  if (!(trace > 0)) return;
  // A step of a metre across is an angle of fx / z pixels: the trace has it.
  const Eigen::Matrix3d planes =
      independent / (options.normal_sigma * options.normal_sigma) / trace * information;
  const Eigen::Matrix3d held =
      Eigen::Matrix3d::Identity() / (options.direction_sigma * options.direction_sigma);
  const Eigen::Vector3d turned = *direction - (planes + held).ldlt().solve(planes * *direction);
  if (turned.allFinite() && turned.norm() > kOneLine) *direction = turned.normalized();
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// What the views say of one point.
struct EdgeAdjustment::Sums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // 1/m^2
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_lag = Eigen::Vector3d::Zero();  // the same, crossed with the lag; and of the lag
  double lag_information = 0, lag_gradient = 0;
  int expected = 0, seen = 0;

  void Add(const Sums& other);
};

void EdgeAdjustment::Sums::Add(const Sums& other) {
  information += other.information;
  gradient += other.gradient;
  by_lag += other.by_lag;
  lag_information += other.lag_information;
  lag_gradient += other.lag_gradient;
  expected += other.expected;
  seen += other.seen;
}

std::vector<std::int32_t> EdgeAdjustment::Visible(const PosedEdges& view,
                                                  const std::vector<MappedPoint>& points) const {
  const PinholeView pinhole(view.T_map_camera, view.camera);
  std::vector<ProjectedPoint> projected;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d p = pinhole.InCamera(points[k].position);
    if (p.z() < 0.05) continue;
    const Eigen::Vector2d pixel = pinhole.Pixel(p);
    if (!view.camera.Contains(pixel, kBorderPx)) continue;
    projected.push_back({static_cast<std::int32_t>(k), pixel.cast<float>(), static_cast<float>(p.z())});
  }
  RemoveOccluded(view.camera, 0, &projected);
  std::vector<std::int32_t> ids;
  ids.reserve(projected.size());
  for (const ProjectedPoint& p : projected) ids.push_back(p.id);
  return ids;
}

void EdgeAdjustment::Collect(int k, const std::vector<MappedPoint>& points, const Search& search,
                             std::vector<Sums>* sums, double* squares, std::size_t* n) const {
  const PosedEdges& view = (*views_)[k];
  const PinholeView pinhole(view.T_map_camera, view.camera);
  for (const std::int32_t id : Visible(view, points)) {
    if ((id + k) % search.every != 0) continue;
    Sighting sighting;
    const Eigen::Vector3d p = pinhole.InCamera(points[id].position);
    if (!Look(pinhole, view, points[id], p, search.radius, &sighting)) continue;
    Sums& s = (*sums)[id];
    ++s.expected;
    if (!sighting.found) continue;
    const double w = sighting.Weight() / (options_.edge_sigma_px * options_.edge_sigma_px);
    const Eigen::RowVector3d j = sighting.by_point * pinhole.R;
    s.information += w * j.transpose() * j;
    s.gradient += w * sighting.off * j.transpose();
    s.by_lag -= w * sighting.way * j.transpose();
    s.lag_information += w * sighting.way * sighting.way;
    s.lag_gradient -= w * sighting.off * sighting.way;
    if (std::abs(sighting.off) < kInlierPx) ++s.seen, *squares += sighting.off * sighting.off, ++*n;
  }
}

void EdgeAdjustment::MovePose(const std::vector<MappedPoint>& points, double radius, const SE3& given,
                              PosedEdges* view) const {
  std::vector<std::int32_t> visible = Visible(*view, points);
  // Every n-th will do for six unknowns.
  const std::size_t stride = 1 + visible.size() / kPointsPerPose;
  for (std::size_t k = 0; k * stride < visible.size(); ++k) visible[k] = visible[k * stride];
  visible.resize((visible.size() + stride - 1) / stride);
  for (int iteration = 0; iteration < 2; ++iteration) {
    const PinholeView pinhole(view->T_map_camera, view->camera);
    // A right-hand perturbation: a point of the camera frame moves by -R^T dp + p x dtheta.
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const std::int32_t id : visible) {
      const Eigen::Vector3d p = pinhole.InCamera(points[id].position);
      Sighting sighting;
      if (p.z() < 0.05 || !Look(pinhole, *view, points[id], p, radius, &sighting) || !sighting.found)
        continue;
      Eigen::Matrix<double, 1, 6> j;
      j << -sighting.by_point * pinhole.R, sighting.by_point * Hat(p);
      const double w = sighting.Weight() / (options_.edge_sigma_px * options_.edge_sigma_px);
      information += w * j.transpose() * j;
      gradient += w * sighting.off * j.transpose();
    }
    information /= kAlike;
    gradient /= kAlike;
    const double per_m2 = 1 / (options_.pose_sigma_m * options_.pose_sigma_m);
    const double per_rad2 = 1 / std::pow(options_.pose_sigma_deg * kRadiansPerDegree, 2);
    Vector6d off;
    off << view->T_map_camera.p - given.p, LogSO3(given.q.conjugate() * view->T_map_camera.q);
    Vector6d prior;
    prior << per_m2, per_m2, per_m2, per_rad2, per_rad2, per_rad2;
    information.diagonal() += prior;
    gradient += prior.cwiseProduct(off);
    const Vector6d step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return;
    view->T_map_camera = view->T_map_camera.Plus(step);
  }
}

AdjustmentSummary EdgeAdjustment::Run(std::vector<MappedPoint>* points) {
  AdjustmentSummary summary;
  std::vector<SE3> given;
  for (const PosedEdges& view : *views_) given.push_back(view.T_map_camera);
  const int n_views = static_cast<int>(views_->size());
  std::vector<MappedPoint> measured = *points;
  for (int round = 0; round <= options_.rounds; ++round) {
    const bool last = round == options_.rounds;
    const double radius = options_.first_radius_px + (options_.last_radius_px - options_.first_radius_px) *
                                                         round / std::max(1, options_.rounds);
    // In the end a point is asked for in all views: how many show it counts.
    const Search search{radius, last ? 1 : 1 + (n_views - 1) / kViewsPerPoint};
    // In parts of fixed size, summed in their order: the same result whatever the number of threads.
    const int parts = std::min(8, n_views);
    std::vector<std::vector<Sums>> sums(parts, std::vector<Sums>(points->size()));
    std::vector<double> squares(parts, 0);
    std::vector<std::size_t> n(parts, 0);
    ParallelFor(parts, threads_, [&](int part) {
      for (int k = part; k < n_views; k += parts)
        Collect(k, *points, search, &sums[part], &squares[part], &n[part]);
    });
    double square = 0;
    std::size_t count = 0;
    for (int part = 0; part < parts; ++part) square += squares[part], count += n[part];
    const double rms = count > 0 ? std::sqrt(square / static_cast<double>(count)) : 0;
    (round == 0 ? summary.rms_before_px : summary.rms_after_px) = rms;

    std::vector<MappedPoint> kept, kept_measured;
    for (std::size_t k = 0; k < points->size(); ++k) {
      MappedPoint point = (*points)[k];
      Sums total;
      for (const auto& part : sums) total.Add(part[k]);
      point.views = total.seen;
      point.seen = total.expected > 0 ? static_cast<double>(total.seen) / total.expected : 0;
      // The first rounds are lenient: points and poses are still on their way.
      const double strict = last ? 1 : 0.6;
      if (total.seen < strict * options_.min_views / search.every || point.seen < strict * options_.min_share)
        continue;
      AlignWithViews(total.information, Independent(total.seen), options_, &point.direction);
      // Of the lag nothing but its prior is known where there are no event views, and nothing changes.
      total.lag_information += 1 / (options_.lag_sigma_px * options_.lag_sigma_px);
      total.lag_gradient += point.lag / (options_.lag_sigma_px * options_.lag_sigma_px);
      total.information -= total.by_lag * total.by_lag.transpose() / total.lag_information;
      total.gradient -= total.by_lag * total.lag_gradient / total.lag_information;
      if (options_.hold_sigmas > 0) {
        const double sigma = options_.hold_sigmas * measured[k].sigma;
        const double per_m2 = 1 / (sigma * sigma + 1e-8);
        total.information.diagonal().array() += per_m2;
        total.gradient += per_m2 * (point.position - measured[k].position);
      }
      // Along the line nothing is known: the point stays where it is.
      const double held = total.information.trace() + 1;
      const Eigen::Matrix3d information =
          total.information + held * point.direction * point.direction.transpose();
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information);
      const double weakest = solver.eigenvalues()[0];
      point.sigma = weakest > 0 ? std::sqrt(total.seen / Independent(total.seen) / weakest) : 1;
      if (!last && weakest > 0) {
        Eigen::Vector3d step = -solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() *
                               solver.eigenvectors().transpose() * total.gradient;
        step -= step.dot(point.direction) * point.direction;
        const double limit = 0.03;  // m
        if (step.norm() > limit) step *= limit / step.norm();
        point.position += step;
        point.lag -= (total.lag_gradient + total.by_lag.dot(step)) / total.lag_information;
      }
      kept.push_back(point);
      kept_measured.push_back(measured[k]);
    }
    points->swap(kept);
    measured.swap(kept_measured);
    if (last || !options_.move_poses) continue;
    ParallelFor(n_views, threads_, [&](int k) { MovePose(*points, radius, given[k], &(*views_)[k]); });
  }
  std::vector<double> moved, turned;
  for (int k = 0; k < n_views; ++k) {
    moved.push_back(((*views_)[k].T_map_camera.p - given[k].p).norm());
    turned.push_back(AngularDistance((*views_)[k].T_map_camera.q, given[k].q) / kRadiansPerDegree);
  }
  summary.moved_m = Median(moved);
  summary.turned_deg = Median(turned);
  return summary;
}

}  // namespace evit
