#include "common/mapping/event_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/mapping/edge_lines.h"

namespace evit {
namespace {

constexpr int kBorder = 4;            // pixels: derivatives need so much around
constexpr double kWarpedWidth = 0.6;  // pixels: how far, at best, the events of an edge lie about it
constexpr double kMostCurved = 0.5;   // of the curvature across, that a ridge may have along itself

// Adds an event, shared out to the four pixels around.
void Splat(float x, float y, cv::Mat* image) {
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  if (column < 0 || row < 0 || column + 1 >= image->cols || row + 1 >= image->rows) return;
  const float a = x - static_cast<float>(column), b = y - static_cast<float>(row);
  float* upper = image->ptr<float>(row) + column;
  float* lower = image->ptr<float>(row + 1) + column;
  upper[0] += (1 - a) * (1 - b), upper[1] += a * (1 - b);
  lower[0] += (1 - a) * b, lower[1] += a * b;
}

// First and second derivatives of an image at a pixel.
struct Shape {
  double dx, dy, dxx, dxy, dyy;

  Shape(const cv::Mat& image, int column, int row) {
    const float* a = image.ptr<float>(row - 1) + column;
    const float* b = image.ptr<float>(row) + column;
    const float* c = image.ptr<float>(row + 1) + column;
    dx = 0.5 * (b[1] - b[-1]), dy = 0.5 * (c[0] - a[0]);
    dxx = b[1] - 2 * b[0] + b[-1], dyy = c[0] - 2 * b[0] + a[0];
    dxy = 0.25 * (c[1] - c[-1] - a[1] + a[-1]);
  }

  // Whether a ridge runs through the pixel: where, across, its top lies from the pixel's middle, and the unit
  // normal.
  bool Ridge(Eigen::Vector2d* normal, double* off) const {
    const double mean = 0.5 * (dxx + dyy), spread = std::hypot(0.5 * (dxx - dyy), dxy);
    const double across = mean - spread, along = mean + spread;
    if (across >= 0 || std::abs(along) > kMostCurved * -across) return false;
    // The eigenvector of `across`, from the better conditioned row.
    Eigen::Vector2d n = dxx < dyy ? Eigen::Vector2d(across - dyy, dxy) : Eigen::Vector2d(dxy, across - dxx);
    if (n.squaredNorm() < 1e-20) n = dxx < dyy ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    n.normalize();
    *off = -(dx * n.x() + dy * n.y()) / across;
    *normal = n;
    return std::abs(*off * n.x()) <= 0.6 && std::abs(*off * n.y()) <= 0.6;
  }
};

}  // namespace

struct EventView::Warped {
  cv::Mat darker, brighter;  // CV_32F: events per pixel
};

EventView::EventView(const Camera& camera, const EventViewOptions& options)
    : distorted_(camera), options_(options), rectifier_(camera) {
  rays_.reserve(static_cast<std::size_t>(camera.width) * camera.height);
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      Eigen::Vector3d ray;
      const bool seen = camera.Unproject({column, row}, &ray);
      rays_.push_back(seen ? Eigen::Vector3f(ray.cast<float>()) : Eigen::Vector3f::Zero());
    }
  }
}

EventView::Warped EventView::Warp(const EventSlice& slice, double depth) const {
  const Camera& pinhole = rectifier_.camera();
  // From the camera at each instant to the one in the middle, for points `depth` away.
  std::vector<Eigen::Matrix3f> R;
  std::vector<Eigen::Vector3f> t;
  const SE3 T_middle_map = slice.T_map_camera[slice.T_map_camera.size() / 2].Inverse();
  for (const SE3& pose : slice.T_map_camera) {
    const SE3 T = T_middle_map * pose;
    R.push_back(T.R().cast<float>());
    t.push_back((T.p / depth).cast<float>());
  }
  const auto last = static_cast<Utime>(R.size()) - 1;
  const Utime span = std::max<Utime>(1, slice.end - slice.begin);
  Warped warped{cv::Mat::zeros(pinhole.height, pinhole.width, CV_32F),
                cv::Mat::zeros(pinhole.height, pinhole.width, CV_32F)};
  std::vector<std::uint8_t> counts(2 * rays_.size(), 0);
  const auto fx = static_cast<float>(pinhole.fx), fy = static_cast<float>(pinhole.fy);
  const auto cx = static_cast<float>(pinhole.cx), cy = static_cast<float>(pinhole.cy);
  const EventArray& events = slice.events;
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (events.x[k] >= distorted_.width || events.y[k] >= distorted_.height) continue;
    const std::size_t at = static_cast<std::size_t>(events.y[k]) * distorted_.width + events.x[k];
    const Eigen::Vector3f& ray = rays_[at];
    if (ray.z() == 0 || counts[2 * at + events.p[k]] >= options_.max_per_pixel) continue;
    ++counts[2 * at + events.p[k]];
    const Utime step =
        std::clamp<Utime>((2 * last * (events.t[k] - slice.begin) + span) / (2 * span), 0, last);
    const Eigen::Vector3f p = R[step] * ray + t[step];
    if (p.z() < 0.1F) continue;
    Splat(fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy,
          events.p[k] != 0 ? &warped.brighter : &warped.darker);
  }
  return warped;
}

void EventView::AddRidges(const cv::Mat& warped, double sign, const CameraSweep& sweep, double depth,
                          std::vector<EdgePixel>* edges) const {
  cv::Mat smooth;
  const double sigma = options_.blur_sigma_px;
  cv::GaussianBlur(warped, smooth, {}, sigma, sigma, cv::BORDER_REPLICATE);
  // A line of m events per pixel, blurred to s pixels, is m / (s sqrt(2 pi)) high.
  const double width = std::sqrt(2 * M_PI) * std::hypot(sigma, kWarpedWidth);
  const Camera& c = rectifier_.camera();
  cv::Mat index(smooth.size(), CV_32S, cv::Scalar(-1));
  std::vector<EdgePixel> found;
  std::vector<char> sure;
  for (int row = kBorder; row < smooth.rows - kBorder; ++row) {
    const float* heights = smooth.ptr<float>(row);
    for (int column = kBorder; column < smooth.cols - kBorder; ++column) {
      const double mass = heights[column] * width;
      if (mass < options_.min_events) continue;
      Eigen::Vector2d normal;
      double off = 0;
      if (!Shape(smooth, column, row).Ridge(&normal, &off)) continue;
      // What lies behind a moving edge spreads: where it gets brighter, the brighter side is behind.
      const Eigen::Vector3d ray((column - c.cx) / c.fx, (row - c.cy) / c.fy, 1);
      const double flow = normal.dot(sweep.Flow(c, depth * ray));
      if (std::abs(flow) < sweep.min_px) continue;
      EdgePixel edge;
      edge.pixel = (Eigen::Vector2d(column, row) + off * normal).cast<float>();
      edge.normal = (flow * sign > 0 ? Eigen::Vector2d(-normal) : normal).cast<float>();
      index.at<int>(row, column) = static_cast<int>(found.size());
      found.push_back(edge);
      sure.push_back(mass >= options_.sure_events ? 1 : 0);
    }
  }
  FitNormals(index, &found);
  const std::vector<EdgePixel> lines = KeepLines(index, found, sure, options_.min_length);
  edges->insert(edges->end(), lines.begin(), lines.end());
}

PosedEdges EventView::Make(const EventSlice& slice, double depth) const {
  CV_Assert(slice.T_map_camera.size() % 2 == 1);
  const SE3& middle = slice.T_map_camera[slice.T_map_camera.size() / 2];
  const SE3 T_first_last = slice.T_map_camera.front().Inverse() * slice.T_map_camera.back();
  CameraSweep sweep;
  sweep.moved = T_first_last.p;
  sweep.turned = LogSO3(T_first_last.q);
  sweep.min_px = options_.min_sweep_px;
  const Warped warped = Warp(slice, depth);
  std::vector<EdgePixel> edges;
  AddRidges(warped.brighter, 1, sweep, depth, &edges);
  AddRidges(warped.darker, -1, sweep, depth, &edges);
  const Camera& pinhole = rectifier_.camera();
  return {middle, pinhole, EdgeImage(pinhole.width, pinhole.height, std::move(edges), true), sweep};
}

}  // namespace evit
