#include "tools/render/run_painter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "common/geometry/degrees.h"
#include "common/wire/geometry_wire.h"
#include "tools/monitor/surface_overlay.h"
#include "tools/pictures/chart.h"

namespace evit::render {
namespace {

constexpr double kFrustumM = 0.35;
constexpr std::int64_t kLongestStepUs = 300'000;  // between two poses of the path: more is a gap

cv::Rect Part(cv::Size size, double x, double y, double width, double height) {
  return {cvRound(size.width * x), cvRound(size.height * y), cvRound(size.width * width),
          cvRound(size.height * height)};
}

double TextSize(const cv::Mat& picture) { return std::max(0.38, picture.rows / 1100.0); }

// Blue on an edge, over grey to orange far from any.
cv::Scalar ResidualColor(std::uint8_t residual) {
  const double t = std::round(residual / 32.0) / 8;
  const cv::Scalar blue(240, 140, 0), gray(168, 143, 143), orange(0, 140, 240);
  return t < 0.5 ? blue + (gray - blue) * (2 * t) : gray + (orange - gray) * (2 * t - 1);
}

cv::Vec3b ToPixel(const cv::Scalar& color) {
  return {cv::saturate_cast<std::uint8_t>(color[0]), cv::saturate_cast<std::uint8_t>(color[1]),
          cv::saturate_cast<std::uint8_t>(color[2])};
}

}  // namespace

RunPainter::RunPainter(const RecordedRun* run, const PointMap& map, const Rig& rig,
                       const PaintOptions& options)
    : run_(run),
      index_(map),
      rig_(rig),
      options_(options),
      theme_(options.dark ? DarkTheme() : LightTheme()),
      map_place_(Part(options.size, 0, 0, 0.62, 1)),
      surface_place_(Part(options.size, 0.63, 0.02, 0.36, 0.48)),
      curves_place_(Part(options.size, 0.63, 0.52, 0.36, 0.46)),
      map_(map.points, map_place_.size(), options.turn_deg / kDegreesPerRadian, theme_) {
  for (const window_state_t& window : run->windows()) {
    const double* v = window.node.back().velocity;
    const auto& c = window.covariance;
    speed_.push_back(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    sigma_.push_back(1e3 * std::sqrt(std::max(0.0, c[0][0] + c[1][1] + c[2][2])));
  }
}

cv::Mat RunPainter::Paint(std::int64_t t) {
  cv::Mat picture(options_.size, CV_8UC3, theme_.back);
  const std::size_t now = run_->WindowAt(t);
  const window_state_t& window = run_->windows()[now];
  const double seconds = 1e-6 * static_cast<double>(t - run_->begin());
  PaintMap(now, (options_.turn_deg + options_.turn_deg_per_s * seconds) / kDegreesPerRadian, &picture);
  PaintSurface(window, &picture);
  const int half = curves_place_.height / 2;
  PaintCurve("speed, m/s", speed_, now, {curves_place_.x, curves_place_.y, curves_place_.width, half - 4},
             &picture);
  PaintCurve("sigma, mm", sigma_, now,
             {curves_place_.x, curves_place_.y + half, curves_place_.width, half - 4}, &picture);
  PaintText(window, &picture);
  return picture;
}

void RunPainter::PaintMap(std::size_t window, double turn, cv::Mat* picture) {
  cv::Mat view = (*picture)(map_place_);
  map_.Background(turn).copyTo(view);
  const auto& windows = run_->windows();
  for (std::size_t i = 1; i <= window; ++i) {
    if (windows[i].utime - windows[i - 1].utime > kLongestStepUs) continue;
    map_.Line(Eigen::Vector3d(windows[i - 1].node.back().position),
              Eigen::Vector3d(windows[i].node.back().position), theme_.accent, 2, &view);
  }
  const SE3 T_map_camera = PoseOf(windows[window].node.back()) * rig_.T_body_camera;
  const Camera& c = rig_.camera;
  Eigen::Vector3d corners[4];
  const double u[] = {0, double(c.width), double(c.width), 0},
               v[] = {0, 0, double(c.height), double(c.height)};
  for (int k = 0; k < 4; ++k) {
    corners[k] = T_map_camera * Eigen::Vector3d(kFrustumM * (u[k] - c.cx) / c.fx,
                                                kFrustumM * (v[k] - c.cy) / c.fy, kFrustumM);
  }
  for (int k = 0; k < 4; ++k) {
    map_.Line(T_map_camera.p, corners[k], theme_.ink, 2, &view);
    map_.Line(corners[k], corners[(k + 1) % 4], theme_.ink, 2, &view);
  }
}

std::vector<Eigen::Vector3f> RunPainter::Visible(const SE3& T_map_camera) const {
  VisibilityQuery query;
  query.T_map_camera = T_map_camera;
  query.camera = rig_.camera;
  query.max_points = static_cast<int>(options_.points);
  std::vector<Eigen::Vector3f> points;
  for (const std::int32_t id : index_.Query(query).ids) {
    points.push_back(index_.map().points[static_cast<std::size_t>(id)]);
  }
  return points;
}

void RunPainter::PaintSurface(const window_state_t& window, cv::Mat* picture) {
  const auto keyframe = run_->KeyframeAt(window.utime);
  if (keyframe && keyframe->encoding == keyframe_t::TIME_SURFACE)
    DrawSurface(*keyframe, PoseOf(window.node.back()));
  if (surface_.empty()) return;
  const cv::Rect place(surface_place_.x + (surface_place_.width - surface_.cols) / 2, surface_place_.y,
                       surface_.cols, surface_.rows);
  surface_.copyTo((*picture)(place));
  cv::rectangle(*picture, place, theme_.soft, 1);
}

void RunPainter::DrawSurface(const keyframe_t& keyframe, const SE3& T_map_body) {
  cv::Mat gray(keyframe.height, keyframe.width, CV_8U);
  std::copy(keyframe.surface.begin(), keyframe.surface.end(), gray.begin<std::uint8_t>());
  const double scale = std::min(surface_place_.width / static_cast<double>(gray.cols),
                                surface_place_.height / static_cast<double>(gray.rows));
  cv::resize(gray, gray, {}, scale, scale, cv::INTER_AREA);
  cv::Mat table(1, 256, CV_8UC3);
  for (int i = 0; i < 256; ++i) {
    // Eight steps, so that moving pictures pack well.
    table.at<cv::Vec3b>(i) = ToPixel(theme_.ink + (theme_.back - theme_.ink) * (std::round(i / 32.0) / 8));
  }
  cv::cvtColor(gray, surface_, cv::COLOR_GRAY2BGR);
  cv::LUT(surface_, table, surface_);
  const SE3 T_map_camera = T_map_body * rig_.T_body_camera;
  // Most edges do not move across the image and have no events: their points are there, and small.
  const int dot = std::max(2, surface_.cols / 130);
  for (const monitor::OverlayPoint& point :
       monitor::ProjectOnto(keyframe, rig_.camera, T_map_camera, Visible(T_map_camera), options_.points)) {
    const cv::Point at(cvRound(scale * point.x), cvRound(scale * point.y));
    cv::rectangle(surface_, cv::Rect(at, point.residual < 192 ? cv::Size(dot, dot) : cv::Size(1, 1)),
                  ResidualColor(point.residual), cv::FILLED);
  }
}

void RunPainter::PaintText(const window_state_t& window, cv::Mat* picture) const {
  static constexpr const char* kModes[] = {"BOOTSTRAPPING", "TRACKING", "LOST"};
  const double size = TextSize(*picture);
  const int line = cvRound(42 * size);
  char text[96];
  std::snprintf(text, sizeof text, "%s", kModes[window.mode]);
  pictures::DrawText(picture, text, {line / 2, line}, 1.4 * size, pictures::Anchor::kLeft, theme_.accent, 2);
  std::snprintf(text, sizeof text, "%.1f s   %.0f %% of %d points on edges",
                1e-6 * static_cast<double>(window.utime - run_->begin()), 100 * window.inlier_share,
                window.n_points);
  pictures::DrawText(picture, text, {line / 2, options_.size.height - line / 2}, size,
                     pictures::Anchor::kLeft, theme_.ink);
}

void RunPainter::PaintCurve(const std::string& name, const std::vector<double>& values, std::size_t now,
                            const cv::Rect& where, cv::Mat* picture) const {
  const double size = TextSize(*picture);
  const int head = cvRound(34 * size);
  const auto& windows = run_->windows();
  const double begin = static_cast<double>(windows.front().utime);
  const double length = std::max(1.0, static_cast<double>(windows.back().utime) - begin);
  const double top = std::max(1e-9, 1.05 * *std::max_element(values.begin(), values.end()));
  const cv::Rect plot(where.x, where.y + head, where.width, where.height - head);
  const auto at = [&](std::size_t i) {
    const double x = (static_cast<double>(windows[i].utime) - begin) / length;
    return cv::Point(plot.x + cvRound(x * plot.width), plot.y + cvRound((1 - values[i] / top) * plot.height));
  };
  cv::line(*picture, {plot.x, plot.y + plot.height}, {plot.x + plot.width, plot.y + plot.height}, theme_.soft,
           1);
  for (std::size_t i = 1; i <= now; ++i) cv::line(*picture, at(i - 1), at(i), theme_.accent, 1, cv::LINE_AA);
  char text[64];
  std::snprintf(text, sizeof text, "%s  %.2g", name.c_str(), values[now]);
  pictures::DrawText(picture, text, {where.x, where.y + head - 4}, size, pictures::Anchor::kLeft, theme_.ink);
}

}  // namespace evit::render
