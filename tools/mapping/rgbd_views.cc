#include "tools/mapping/rgbd_views.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "common/mapping/sensor_depth.h"
#include "common/parallel/parallel_for.h"
#include "tools/formats/rgbd/rgbd_folder.h"

namespace evit::mapping {

RgbdEdges ReadRgbd(const std::string& path, std::size_t begin, std::size_t end,
                   const FrameReaderOptions& options, double max_depth_m,
                   const std::function<void(double)>& progress) {
  const formats::RgbdFolder folder(path);
  end = std::min(end, folder.size());
  if (begin >= end)
    throw std::runtime_error(path + ": has only " + std::to_string(folder.size()) + " images");
  const std::size_t stride =
      std::max<std::size_t>(1, (end - begin + options.max_frames - 1) / options.max_frames);
  const int n = static_cast<int>((end - begin + stride - 1) / stride);
  SensorDepthOptions sensor;
  sensor.max_depth_m = max_depth_m;
  std::vector<std::vector<EdgeDepth>> depths(n);
  std::vector<PosedEdges> views;
  for (int k = 0; k < n; ++k) views.push_back({{}, {}, EdgeImage(1, 1, {}, true)});
  std::mutex mutex;  // of progress
  int done = 0;
  ParallelFor(n, options.threads, [&](int k) {
    RgbdView view = folder.Load(begin + static_cast<std::size_t>(k) * stride);
    cv::Mat grey;
    cv::Mat(view.camera.height, view.camera.width, CV_32F, view.intensity.data()).convertTo(grey, CV_8U, 255);
    views[k] = {view.T_map_camera, view.camera,
                EdgeImage(grey.cols, grey.rows, DetectEdges(grey, cv::Mat(), options.edges), true)};
    depths[k] = DepthsFromImage(views[k], cv::Mat(grey.rows, grey.cols, CV_32F, view.depth.data()), sensor);
    const std::lock_guard<std::mutex> lock(mutex);
    progress(++done / static_cast<double>(n));
  });
  RgbdEdges result;
  result.frames.read = static_cast<std::size_t>(n);
  for (int k = 0; k < n; ++k) {
    if (depths[k].size() < 100) {
      ++result.frames.poor;
      continue;
    }
    result.depths.push_back({static_cast<int>(result.frames.views.size()), std::move(depths[k])});
    result.frames.views.push_back(std::move(views[k]));
    result.frames.stamps.push_back(static_cast<Utime>(begin) + k * static_cast<Utime>(stride));
  }
  if (result.frames.views.size() < 3) {
    throw std::runtime_error(path + ": " + std::to_string(result.frames.views.size()) + " of " +
                             std::to_string(n) +
                             " images show edges with a depth, a map needs three; are the depth images in "
                             "millimetres?");
  }
  return result;
}

}  // namespace evit::mapping
