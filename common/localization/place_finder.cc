#include "common/localization/place_finder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "common/parallel/parallel_for.h"
#include "common/tracking/alignment_significance.h"
#include "common/tracking/start_search.h"

namespace evit {
namespace {

constexpr StartRange kFromMatch{0.15, 0.09, 5};  // half the grid's spacing and a yaw bin, and the tilt
constexpr StartRange kAround{0.2, 0.1, 4};       // a repeated pattern may have been met one repeat away
constexpr StartRange kPredicted{0.05, 0.03, 4};  // 50 ms on, by the IMU
constexpr double kUsualPlaces = 15'000;
constexpr int kIterations = 8;              // from a match: enough to tell which are worth more
constexpr int kFewestPlaces = 25;           // of the panorama, with an edge: fewer fit anywhere
constexpr std::size_t kSearched = 6;        // of the best matches, around which to search
constexpr std::size_t kAlike = 24;          // places that look as one that was found, of 15,000; more of more
constexpr std::size_t kShownPoints = 6000;  // of the map, that show how it looks from there
constexpr double kSamePlace = 0.05, kSameAngle = 0.05;  // m, rad: nearer poses are one

bool Same(const SE3& a, const SE3& b) {
  return (a.p - b.p).norm() < kSamePlace && AngularDistance(a.q, b.q) < kSameAngle;
}

// The most significant first; of the same pose the most significant only.
void SortOut(std::vector<PlaceCandidate>* candidates, std::size_t count) {
  std::stable_sort(
      candidates->begin(), candidates->end(),
      [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.significance > b.significance; });
  std::vector<PlaceCandidate> kept;
  for (const PlaceCandidate& c : *candidates) {
    if (kept.size() == count) break;
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const PlaceCandidate& k) { return Same(k.T_map_body, c.T_map_body); })) {
      kept.push_back(c);
    }
  }
  *candidates = std::move(kept);
}

bool LessSignificant(const PlaceCandidate& a, const PlaceCandidate& b) {
  return a.significance < b.significance;
}

// R_up_body of some azimuth.
Eigen::Quaterniond UprightOf(const PlaceQuery& query) {
  return Eigen::Quaterniond::FromTwoVectors(query.up_body, Eigen::Vector3d::UnitZ());
}

// The body's pose where its camera is at `at`.
SE3 BodyAt(const PlaceQuery& query, const Rig& rig, const Eigen::Vector3f& at, double yaw) {
  SE3 pose;
  pose.q = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * UprightOf(query);
  pose.p = at.cast<double>() - pose.q * rig.T_body_camera.p;
  return pose;
}

// The surface that points of the map would cause, seen from a pose: all of them, and nothing else.
cv::Mat Shown(const Rig& rig, const AlignmentPoints& points, const SE3& T_map_body) {
  cv::Mat surface(rig.camera.height, rig.camera.width, CV_8UC1, cv::Scalar(255));
  const SE3 T_camera_map = (T_map_body * rig.T_body_camera).Inverse();
  for (std::size_t k = 0; k < points.size(); ++k) {
    Eigen::Vector2d pixel;
    if (!rig.camera.Project(T_camera_map * points.At(k), &pixel)) continue;
    const cv::Point at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
    if (cv::Rect(0, 0, surface.cols, surface.rows).contains(at)) surface.at<std::uint8_t>(at) = 0;
  }
  cv::erode(surface, surface, cv::Mat());  // as thick as a surface's edges
  return surface;
}

// The more places there are, the more look alike by chance, and the lower the right one ranks.
std::size_t MatchesOf(const PlaceIndex& index, std::size_t matches) {
  const double growth = std::sqrt(static_cast<double>(index.places().size()) / kUsualPlaces);
  return static_cast<std::size_t>(static_cast<double>(matches) * std::max(1.0, growth));
}

}  // namespace

PlaceFinder::PlaceFinder(const MapIndex& map, const PlaceIndex& index, const Rig& rig,
                         const PointOptions& points, const WindowOptions& window,
                         const PlaceFinderOptions& options)
    : map_(map),
      index_(index),
      rig_(rig),
      points_(points),
      alignment_(MakeAlignmentSettings(rig, window)),
      options_(options) {}

std::vector<PlaceCandidate> PlaceFinder::Answer(const PlaceQuery& query) const {
  const SurfaceField field(query.surface, kFromMatch.levels);
  std::vector<PlaceCandidate> answer = Refined(query, field), others;
  if (query.everywhere) {
    others = Everywhere(query, field, answer);
  } else if (!answer.empty()) {
    const PlaceCandidate& best = *std::max_element(answer.begin(), answer.end(), LessSignificant);
    others.push_back(Searched(field, best.T_map_body, kAround, query.number));
  }
  for (const PlaceCandidate& other : others) {
    const bool known = std::any_of(answer.begin(), answer.end(), [&](const PlaceCandidate& a) {
      return Same(a.T_map_body, other.T_map_body);
    });
    if (!known) answer.push_back(other);
  }
  return answer;
}

std::vector<PlaceCandidate> PlaceFinder::Refined(const PlaceQuery& query, const SurfaceField& field) const {
  std::vector<PlaceCandidate> refined(query.hypotheses.size());
  ParallelFor(static_cast<int>(refined.size()), options_.threads, [&](int k) {
    const AlignmentPoints points = PointsAt(query.hypotheses[k]);
    const SE3 pose = LocalizeBest(alignment_, field, points, query.hypotheses[k], kPredicted).T_map_body;
    refined[k] = {pose, AlignmentSignificance(alignment_, field, points, pose), 0,
                  static_cast<int>(points.size())};
  });
  return refined;
}

std::vector<PlaceMatch> PlaceFinder::Matches(const PlaceQuery& query, const cv::Mat& surface,
                                             std::size_t count) const {
  const EventPanorama panorama(surface, rig_.camera, UprightOf(query) * rig_.T_body_camera.q,
                               options_.directions);
  if (panorama.occupied() < kFewestPlaces) return {};
  std::function<bool(const Eigen::Vector3f&, double)> allowed;
  if (!query.prior.open()) {
    allowed = [&](const Eigen::Vector3f& at, double yaw) {
      return query.prior.Allows(BodyAt(query, rig_, at, yaw), index_.spacing(), panorama::kBin);
    };
  }
  return options_.panoramas ? BestMatches(index_, panorama, count, allowed, options_.threads)
                            : SpreadEvenly(count, allowed);
}

std::vector<PlaceCandidate> PlaceFinder::Everywhere(const PlaceQuery& query, const SurfaceField& field,
                                                    const std::vector<PlaceCandidate>& refined) const {
  std::vector<PlaceMatch> matches = Matches(query, query.surface, MatchesOf(index_, options_.matches));
  const auto best = std::max_element(refined.begin(), refined.end(), LessSignificant);
  if (best != refined.end() && best->significance >= kStartSignificance) {
    const AlignmentPoints points = PointsAt(best->T_map_body, kShownPoints);
    const cv::Mat shown = Shown(rig_, points, best->T_map_body);
    for (const PlaceMatch& alike : Matches(query, shown, MatchesOf(index_, kAlike))) matches.push_back(alike);
  }
  std::vector<PlaceCandidate> aligned(matches.size());
  ParallelFor(static_cast<int>(matches.size()), options_.threads, [&](int k) {
    aligned[k] = Aligned(field, BodyAt(query, rig_, matches[k].at, matches[k].yaw), kFromMatch);
    aligned[k].likeness = matches[k].score;
  });
  SortOut(&aligned, options_.candidates);
  std::vector<PlaceCandidate> searched(std::min(kSearched, aligned.size()));
  ParallelFor(static_cast<int>(searched.size()), options_.threads, [&](int k) {
    searched[k] = Searched(field, aligned[k].T_map_body, kAround, query.number);
    searched[k].likeness = aligned[k].likeness;
  });
  aligned.insert(aligned.end(), searched.begin(), searched.end());
  SortOut(&aligned, options_.candidates);
  return aligned;
}

std::vector<PlaceMatch> PlaceFinder::SpreadEvenly(
    std::size_t count, const std::function<bool(const Eigen::Vector3f&, double)>& allowed) const {
  constexpr double kGoldenAngle = 2.39996;
  const std::vector<PlaceIndex::Place>& places = index_.places();
  // All of them where a prior leaves some.
  const std::size_t n = allowed ? places.size() : std::min(count, places.size());
  std::vector<PlaceMatch> matches;
  for (std::size_t k = 0; k < n; ++k) {
    const PlaceMatch match{places[k * places.size() / n].at, kGoldenAngle * static_cast<double>(k), 0};
    if (!allowed || allowed(match.at, match.yaw)) matches.push_back(match);
  }
  const std::size_t left = std::min(count, matches.size());
  for (std::size_t k = 0; k < left; ++k) matches[k] = matches[k * matches.size() / left];
  matches.resize(left);
  return matches;
}

PlaceCandidate PlaceFinder::Aligned(const SurfaceField& field, const SE3& T_map_body,
                                    const StartRange& range) const {
  const AlignmentPoints points = PointsAt(T_map_body);
  const SE3 pose = Localize(alignment_, field, points, T_map_body, range, kIterations).T_map_body;
  return {pose, AlignmentSignificance(alignment_, field, points, pose), 0, static_cast<int>(points.size())};
}

PlaceCandidate PlaceFinder::Searched(const SurfaceField& field, const SE3& T_map_body,
                                     const StartRange& range, std::int64_t number) const {
  const AlignmentPoints points = PointsAt(T_map_body);
  const SE3 pose = SearchStart(alignment_, field, points, T_map_body, range, number).T_map_body;
  return {pose, AlignmentSignificance(alignment_, field, points, pose), 0, static_cast<int>(points.size())};
}

AlignmentPoints PlaceFinder::PointsAt(const SE3& T_map_body, std::size_t most) const {
  VisibilityQuery query;
  query.T_map_camera = T_map_body * rig_.T_body_camera;
  query.camera = rig_.camera;
  query.margin_px = points_.margin_px;
  query.min_depth = points_.min_depth_m;
  query.max_depth = points_.max_depth_m;
  query.occlusion = points_.occlusion;
  query.max_points = static_cast<int>(most);
  query.seed = static_cast<std::uint64_t>(points_.seed);
  std::vector<Eigen::Vector3f> points;
  for (const std::int32_t id : map_.Query(query).ids) points.push_back(map_.map().points[id]);
  return {points};
}

}  // namespace evit
