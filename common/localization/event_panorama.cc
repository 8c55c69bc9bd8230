#include "common/localization/event_panorama.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit {
namespace {

using namespace panorama;  // NOLINT(google-build-using-namespace): this file is about nothing else

constexpr int kWidth = 320;            // pixels that the surface is reduced to at least
constexpr double kLively = 0.97;       // share of pixels with less events around than one on an edge
constexpr float kLeastWeight = 0.05F;  // of such a pixel, 0..1: below it there are no edges, only noise
constexpr float kRecent = 0.4F;        // of that weight, from which a pixel counts as lying on an edge
constexpr double kCoherent = 0.3;      // 0..1: from which the gradients around a pixel agree on a direction
constexpr double kEnough = 0.35;    // of a place's width, in pixels that are on an edge: an edge goes across
constexpr double kNarrowest = 0.3;  // of a place on the horizon: narrower ones count as if they were so wide
constexpr int kReach = 2;           // places: farther from an edge than that is nowhere near
constexpr double kFade = 1.2;       // places: standard deviation of nearness
constexpr double kDrawn =
    30;  // places, as many as a row has in sight: weight of the whole picture's mean in its own
constexpr double kScale = 30;  // gain of 1 as a whole number: a thousand of them fit into 16 bits

using Pictures = std::vector<std::array<float, kColumns>>;  // kStackedRows

cv::Mat Reduced(const cv::Mat& surface, int* factor) {
  cv::Mat small = surface;
  for (*factor = 1; small.cols >= 2 * kWidth; *factor *= 2) cv::pyrDown(small, small);
  return small;
}

// How much is going on around each pixel, 0..1.
cv::Mat WeightsOf(const cv::Mat& image) {
  cv::Mat weights;
  image.convertTo(weights, CV_32F, -1.0 / 255, 1);
  cv::GaussianBlur(weights, weights, {5, 5}, 1);
  return weights;
}

// The weight of pixels on an edge: what the liveliest of them have. A slow or poor sensor has less
// everywhere.
float FullWeight(const cv::Mat& weights) {
  std::vector<float> all(weights.begin<float>(), weights.end<float>());
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(kLively * static_cast<double>(all.size()));
  std::nth_element(all.begin(), at, all.end());
  return std::max(*at, kLeastWeight);
}

// Direction of edges at each pixel, from the structure tensor: angle in the image (rad), and how sure.
struct EdgeImage {
  cv::Mat angle, coherence;  // CV_32F
};
EdgeImage EdgesOf(const cv::Mat& image) {
  cv::Mat gx, gy;
  cv::Sobel(image, gx, CV_32F, 1, 0);
  cv::Sobel(image, gy, CV_32F, 0, 1);
  cv::Mat xx = gx.mul(gx), yy = gy.mul(gy), xy = gx.mul(gy);
  for (cv::Mat* m : {&xx, &yy, &xy}) cv::boxFilter(*m, *m, CV_32F, {7, 7});
  EdgeImage edges{cv::Mat(image.size(), CV_32F), cv::Mat(image.size(), CV_32F)};
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const float a = xx.at<float>(v, u) - yy.at<float>(v, u), b = 2 * xy.at<float>(v, u);
      const float trace = xx.at<float>(v, u) + yy.at<float>(v, u);
      edges.angle.at<float>(v, u) = 0.5F * std::atan2(b, a) + static_cast<float>(kPi / 2);
      edges.coherence.at<float>(v, u) = trace > 0 ? std::hypot(a, b) / trace : 0;
    }
  }
  return edges;
}

// Adds an event's edge to the two nearest directions, and to the picture of all.
void Vote(const PictureLine& line, bool coherent, int at, float weight, Pictures* pictures) {
  const int row = at / kColumns, column = at % kColumns;
  (*pictures)[kAnyDirection * kRows + row][column] += weight;
  if (!coherent) {
    for (int d = 0; d < kDirections; ++d) (*pictures)[d * kRows + row][column] += weight / 2;
    return;
  }
  const float place = std::atan2(line.north, line.east) * (kDirections / static_cast<float>(kPi));
  const int below = static_cast<int>(std::floor(place));
  const float part = place - static_cast<float>(below);
  (*pictures)[(below & (kDirections - 1)) * kRows + row][column] += weight * (1 - part);
  (*pictures)[((below + 1) & (kDirections - 1)) * kRows + row][column] += weight * part;
}

// How near each place is to one that holds an edge, 0..1: distances on the sphere.
Pictures Nearness(const Pictures& held) {
  Pictures near(held.size());
  for (std::size_t r = 0; r < held.size(); ++r) {
    const int row = static_cast<int>(r) % kRows;
    const double shrink = std::cos((row + 0.5) * kBin - kPi / 2);
    const int across = std::min(kColumns / 2, static_cast<int>(std::ceil(kReach / std::max(shrink, 0.05))));
    for (int c = 0; c < kColumns; ++c) {
      const float value = held[r][c];
      if (value <= 0) continue;
      for (int dr = -kReach; dr <= kReach; ++dr) {
        if (row + dr < 0 || row + dr >= kRows) continue;
        for (int dc = -across; dc <= across; ++dc) {
          const double d2 = dr * dr + dc * dc * shrink * shrink;
          if (d2 > (kReach + 0.5) * (kReach + 0.5)) continue;
          float& there = near[r + static_cast<std::size_t>(dr + kRows) - kRows][(c + dc) & (kColumns - 1)];
          there = std::max(there, value * static_cast<float>(std::exp(-0.5 * d2 / (kFade * kFade))));
        }
      }
    }
  }
  return near;
}

// What a keyframe shows, place by place.
struct Seen {
  Pictures held{kStackedRows};  // how much of an edge each place holds
  std::vector<std::array<bool, kColumns>> in_sight{kRows};
};

// The pixels of a surface on the sphere around an upright viewer.
class Projection {
 public:
  Projection(const Camera& camera, const Eigen::Quaterniond& R_up_camera, int factor)
      : camera_(camera), R_(R_up_camera.toRotationMatrix().cast<float>()), factor_(factor) {}

  // Direction of pixel (u, v) of the reduced image; false where the lens sees nothing there.
  bool Ray(double u, double v, Eigen::Vector3f* ray) const {
    Eigen::Vector3d in_camera;
    if (!camera_.Unproject({u * factor_, v * factor_}, &in_camera)) return false;
    *ray = R_ * in_camera.cast<float>();
    return true;
  }

 private:
  const Camera& camera_;
  Eigen::Matrix3f R_;
  int factor_;
};

Seen Look(const cv::Mat& image, const Projection& projection) {
  Seen seen;
  const EdgeImage edges = EdgesOf(image);
  const cv::Mat weights = WeightsOf(image);
  const float full = FullWeight(weights);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      Eigen::Vector3f d, beside;
      if (!projection.Ray(u, v, &d)) continue;
      const int at = PlaceOf(d.x(), d.y(), d.z());
      seen.in_sight[at / kColumns][at % kColumns] = true;
      const float weight = weights.at<float>(v, u) / full, angle = edges.angle.at<float>(v, u);
      if (weight < kRecent || !projection.Ray(u + std::cos(angle), v + std::sin(angle), &beside)) continue;
      const Eigen::Vector3f along = beside - d;
      Vote(LineAt(d.x(), d.y(), d.z(), along.x(), along.y(), along.z()),
           edges.coherence.at<float>(v, u) > kCoherent, at, std::min(1.0F, weight), &seen.held);
    }
  }
  return seen;
}

// From pixels to shares of an edge that goes across: 1 is one or more. `width`: of a place on the horizon,
// pixels. Places are narrower towards the poles, and so is what they hold.
void Normalise(double width, Pictures* held) {
  for (std::size_t r = 0; r < held->size(); ++r) {
    const double row = static_cast<double>(r % kRows) + 0.5;
    const double shrink = std::max(kNarrowest, std::cos(row * kBin - kPi / 2));
    for (float& value : (*held)[r])
      value = std::min(1.0F, value / static_cast<float>(kEnough * width * shrink));
  }
}

// Mean of each row of a direction's picture over what is in sight; where little is, drawn towards the mean of
// the whole picture. To be subtracted: edges and events crowd at the horizon of any large room, which says
// nothing about the place.
std::array<double, kRows> MeansInSight(const Pictures& near, const Seen& seen, int direction) {
  std::array<double, kRows> sums{}, counts{};
  double sum = 0, count = 0;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      if (!seen.in_sight[r][c]) continue;
      sums[r] += near[direction * kRows + r][c];
      counts[r] += 1;
    }
    sum += sums[r];
    count += counts[r];
  }
  const double mean = count > 0 ? sum / count : 0;
  for (int r = 0; r < kRows; ++r) sums[r] = (sums[r] + kDrawn * mean) / (counts[r] + kDrawn);
  return sums;
}

}  // namespace

EventPanorama::EventPanorama(const cv::Mat& surface, const Camera& camera,
                             const Eigen::Quaterniond& R_up_camera, bool directions)
    : gain_(kStackedRows), sight_(kRows) {
  int factor = 1;
  const cv::Mat image = Reduced(surface, &factor);
  Seen seen = Look(image, Projection(camera, R_up_camera, factor));
  Normalise(kBin * camera.fx / factor, &seen.held);
  Pictures near = Nearness(seen.held);
  if (!directions) {
    for (int d = 0; d < kDirections; ++d)
      std::copy_n(near.begin() + kAnyDirection * kRows, kRows, near.begin() + d * kRows);
  }
  double squares = 0, places = 0;
  for (int d = 0; d <= kDirections; ++d) {
    const std::array<double, kRows> means = MeansInSight(near, seen, d);
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kColumns; ++c) {
        if (!seen.in_sight[r][c]) continue;
        const double gain = near[d * kRows + r][c] - means[r];
        squares += gain * gain;
        places += 1;
        occupied_ += d == kAnyDirection && seen.held[d * kRows + r][c] > 0.5F ? 1 : 0;
        row_in_sight_[r] = true;
        // Column c is met by an edge at column e where the yaw is e - c, and so lies at -c in the row.
        const int back = (kColumns - c) % kColumns;
        for (const int at : {back, back + kColumns}) {
          gain_[d * kRows + r][at] = static_cast<std::int16_t>(std::lround(kScale * gain));
          sight_[r][at] = 1;
        }
      }
    }
  }
  sigma_ = places > 0 ? std::max(1.0, kScale * std::sqrt(squares / places)) : 1;
}

}  // namespace evit
