#include "tools/mapping/depth_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <utility>

#include "common/mapping/sensor_depth.h"
#include "common/parallel/parallel_for.h"
#include "tools/formats/frames/decode_picture.h"

namespace evit::mapping {
namespace {

// A view and the depth image that belongs to it.
struct Pair {
  std::size_t view = 0, depth = 0;
  SE3 T_map_depth;
};

std::vector<Pair> PairByStamp(const ReadFrames& frames, const DepthFrames& depth,
                              const std::vector<Utime>& stamps) {
  std::vector<std::pair<Utime, std::size_t>> sorted;
  for (std::size_t k = 0; k < stamps.size(); ++k) sorted.emplace_back(stamps[k], k);
  std::sort(sorted.begin(), sorted.end());
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < frames.views.size(); ++k) {
    const Utime t = frames.stamps[k] - depth.clock_offset;
    auto nearest = std::lower_bound(sorted.begin(), sorted.end(), std::make_pair(t, std::size_t{0}));
    if (nearest == sorted.end() ||
        (nearest != sorted.begin() && t - std::prev(nearest)->first < nearest->first - t))
      nearest = std::prev(nearest);
    Pair pair{k, nearest->second, {}};
    if (std::llabs(nearest->first - t) > depth.max_apart) continue;
    if (PoseAt(depth.poses, nearest->first, &pair.T_map_depth)) pairs.push_back(pair);
  }
  return pairs;
}

std::vector<Pair> FindPairs(const ReadFrames& frames, const DepthFrames& depth) {
  const Utime begin = frames.stamps.front(), end = frames.stamps.back();
  const auto stamps = StampsOf(*depth.source, begin - depth.clock_offset, end - depth.clock_offset);
  if (stamps) {
    std::vector<Pair> pairs = PairByStamp(frames, depth, *stamps);
    if (pairs.size() >= 3) return pairs;
    const auto [first, last] = std::minmax_element(stamps->begin(), stamps->end());
    throw std::runtime_error(depth.path + ": " + std::to_string(pairs.size()) + " of " +
                             std::to_string(frames.views.size()) + " pictures have a depth image within " +
                             std::to_string(depth.max_apart / 1000) + " ms; depth is of " +
                             std::to_string(*first / 1'000'000) + " to " + std::to_string(*last / 1'000'000) +
                             " s, pictures are of " + std::to_string(begin / 1'000'000) + " to " +
                             std::to_string(end / 1'000'000) + " s: another recording, or another clock");
  }
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < frames.views.size(); ++k) {
    if (frames.indices[k] >= depth.source->frames().size()) {
      throw std::runtime_error(
          depth.path + ": holds " + std::to_string(depth.source->frames().size()) +
          " depth images without stamps, fewer than there are pictures; expected one for "
          "each, or a list depth.txt with \"stamp name\" lines");
    }
    pairs.push_back({k, frames.indices[k], frames.views[k].T_map_camera});
  }
  return pairs;
}

cv::Mat Read(const DepthFrames& depth, const formats::StoredPicture& picture, const std::string& name) {
  cv::Mat image = formats::DecodeDepth(picture, depth.units_per_metre, name);
  if (image.cols == depth.camera.width && image.rows == depth.camera.height) return image;
  throw std::runtime_error(name + ": is " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                           ", but the depth camera's file says " + std::to_string(depth.camera.width) + "x" +
                           std::to_string(depth.camera.height) + "; name its own with --depth-camera");
}

// A disc of depth, as large as a pixel of the depth image is in the other.
void Splat(const Eigen::Vector3d& p, double radius, const Camera& to, cv::Mat* depth) {
  const double column = to.fx * p.x() / p.z() + to.cx, row = to.fy * p.y() / p.z() + to.cy;
  const int left = std::max(0, static_cast<int>(std::ceil(column - radius)));
  const int right = std::min(to.width - 1, static_cast<int>(std::floor(column + radius)));
  const int top = std::max(0, static_cast<int>(std::ceil(row - radius)));
  const int bottom = std::min(to.height - 1, static_cast<int>(std::floor(row + radius)));
  const auto z = static_cast<float>(p.z());
  for (int r = top; r <= bottom; ++r) {
    for (int c = left; c <= right; ++c) {
      float& at = depth->at<float>(r, c);
      if (at == 0 || z < at) at = z;
    }
  }
}

}  // namespace

cv::Mat MoveDepth(const cv::Mat& depth, const Camera& from, const SE3& T_to_from, const Camera& to) {
  cv::Mat moved(to.height, to.width, CV_32F, cv::Scalar(0));
  const double finer = std::max(to.fx / from.fx, to.fy / from.fy);
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column) {
      const double z = depth.at<float>(row, column);
      Eigen::Vector3d ray;
      if (z <= 0 || !from.Unproject({column, row}, &ray)) continue;
      const Eigen::Vector3d p = T_to_from * (z * ray);
      if (p.z() > 0.01) Splat(p, std::max(0.5, 0.5 * finer * z / p.z()) + 0.01, to, &moved);
    }
  }
  return moved;
}

RgbdEdges AddDepths(ReadFrames frames, const DepthFrames& depth,
                    const std::function<void(double)>& progress) {
  const std::vector<Pair> pairs = FindPairs(frames, depth);
  SensorDepthOptions sensor;
  sensor.max_depth_m = depth.max_depth_m;
  std::vector<std::vector<EdgeDepth>> depths(pairs.size());
  const std::size_t at_once = 4 * static_cast<std::size_t>(depth.threads);
  for (std::size_t begin = 0; begin < pairs.size(); begin += at_once) {
    const std::size_t n = std::min(at_once, pairs.size() - begin);
    std::vector<formats::StoredPicture> stored(n);
    for (std::size_t k = 0; k < n; ++k) stored[k] = depth.source->Fetch(pairs[begin + k].depth);
    ParallelFor(static_cast<int>(n), depth.threads, [&](int k) {
      const Pair& pair = pairs[begin + k];
      const PosedEdges& view = frames.views[pair.view];
      const cv::Mat image = Read(depth, stored[k], depth.source->frames()[pair.depth].name);
      const SE3 T_view_depth = view.T_map_camera.Inverse() * pair.T_map_depth;
      depths[begin + k] =
          DepthsFromImage(view, MoveDepth(image, depth.camera, T_view_depth, view.camera), sensor);
    });
    progress(static_cast<double>(begin + n) / static_cast<double>(pairs.size()));
  }
  constexpr std::size_t kFewest = 100;  // depths of a view worth having
  RgbdEdges result;
  result.frames.read = frames.read;
  result.frames.contrast = frames.contrast;
  result.frames.unreadable = frames.unreadable;
  result.frames.first_unreadable = frames.first_unreadable;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (depths[k].size() < kFewest) continue;
    const std::size_t view = pairs[k].view;
    result.depths.push_back({static_cast<int>(result.frames.views.size()), std::move(depths[k])});
    result.frames.views.push_back(std::move(frames.views[view]));
    result.frames.stamps.push_back(frames.stamps[view]);
    result.frames.indices.push_back(frames.indices[view]);
  }
  result.frames.poor = frames.read - frames.unreadable - result.frames.views.size();
  if (result.frames.views.size() < 3) {
    throw std::runtime_error(depth.path + ": " + std::to_string(result.frames.views.size()) + " of " +
                             std::to_string(frames.read) +
                             " pictures show edges with a depth, a map needs three; do units (--depth-scale) "
                             "and calibration of the depth camera fit?");
  }
  return result;
}

}  // namespace evit::mapping
