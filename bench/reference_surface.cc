#include "bench/reference_surface.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit::bench {

ReferenceSurface::ReferenceSurface(int width, int height) {
  for (cv::Mat& plane : latest_) plane = cv::Mat(height, width, CV_64F, cv::Scalar(-1e9));
  map_x_ = cv::Mat(height, width, CV_32F);
  map_y_ = cv::Mat(height, width, CV_32F);
  for (int y = 0; y < height; ++y) {  // a mild radial distortion
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) - 305) / 327, v = (static_cast<float>(y) - 235) / 327;
      const float radial = 1 - 0.032F * (u * u + v * v);
      map_x_.at<float>(y, x) = 305 + 327 * u * radial;
      map_y_.at<float>(y, x) = 235 + 327 * v * radial;
    }
  }
}

std::vector<ReferenceSurface::Event> ReferenceSurface::From(const EventArray& events) {
  std::vector<Event> out;
  for (std::size_t k = 0; k < events.size(); ++k) {
    out.push_back({static_cast<double>(events.t[k]) * 1e-6, events.x[k], events.y[k], events.p[k] != 0});
  }
  return out;
}

void ReferenceSurface::Update(const std::vector<Event>& events) {
  for (const Event& e : events) {
    if (e.x < 0 || e.y < 0 || e.x >= latest_[0].cols || e.y >= latest_[0].rows) continue;
    latest_[e.polarity ? 1 : 0].at<double>(e.y, e.x) = e.t;
  }
}

cv::Mat ReferenceSurface::Render(double t, double decay_s) {
  cv::Mat surface(latest_[0].size(), CV_64F);
  for (int y = 0; y < surface.rows; ++y) {
    for (int x = 0; x < surface.cols; ++x) {
      const double newest = std::max(latest_[0].at<double>(y, x), latest_[1].at<double>(y, x));
      const double value = 255 * std::exp(-(t - newest) / decay_s);
      surface.at<double>(y, x) = value < 20 ? 0 : value;
    }
  }
  cv::Mat upright, soft, negated;
  cv::remap(surface, upright, map_x_, map_y_, cv::INTER_LINEAR);
  cv::GaussianBlur(upright, soft, cv::Size(), 1);
  cv::Mat(255 - soft).convertTo(negated, CV_8U);
  return negated;
}

}  // namespace evit::bench
