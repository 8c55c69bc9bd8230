#include "tools/mapping/frame_reader.h"

#include <algorithm>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "common/mapping/rectifier.h"
#include "common/parallel/parallel_for.h"

namespace evit::mapping {
namespace {

constexpr std::size_t kLeastEdges = 200;  // of a frame that shows something
constexpr int kSamples = 9;               // pictures that the contrast of edges is found from
constexpr double kLeastContrast = 0.12;   // of edges: below it, noise looks like them

cv::Mat ReadGrey(const std::string& path, const Camera& camera) {
  cv::Mat image = cv::imread(path, cv::IMREAD_ANYDEPTH | cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw std::runtime_error(path + ": cannot be read as a picture");
  if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 1.0 / 257);
  if (image.type() != CV_8UC1) throw std::runtime_error(path + ": expected 8 or 16 bits per channel");
  if (image.cols != camera.width || image.rows != camera.height) {
    throw std::runtime_error(path + ": is " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                             ", but the camera file says " + std::to_string(camera.width) + "x" +
                             std::to_string(camera.height) +
                             "; give the calibration of this camera, scaled to the pictures' size");
  }
  return image;
}

// Cameras compress contrast by their gamma, and rooms differ: as low as it takes for a middling picture to
// show edges as long as twice around it.
double FindContrast(const FrameList& list, const Camera& camera, const Rectifier& rectifier,
                    const FrameReaderOptions& options) {
  const int n = std::min(kSamples, static_cast<int>(list.frames.size()));
  std::vector<cv::Mat> images(n);
  ParallelFor(n, options.threads, [&](int k) {
    const std::size_t at =
        (2 * static_cast<std::size_t>(k) + 1) * list.frames.size() / (2 * static_cast<std::size_t>(n));
    images[k] = rectifier.Rectify(ReadGrey(list.frames[at].path, camera));
  });
  const auto enough = static_cast<std::size_t>(4 * (camera.width + camera.height));
  double contrast = options.edges.sure_contrast;
  for (; contrast > kLeastContrast; contrast = std::max(kLeastContrast, 0.7 * contrast)) {
    EdgeDetectorOptions detector = options.edges;
    detector.sure_contrast = contrast, detector.min_contrast = contrast / 2;
    std::vector<std::size_t> counts(n);
    ParallelFor(n, options.threads,
                [&](int k) { counts[k] = DetectEdges(images[k], rectifier.valid(), detector).size(); });
    std::sort(counts.begin(), counts.end());
    if (n == 0 || counts[counts.size() / 2] >= enough) break;
  }
  return contrast;
}

}  // namespace

ReadFrames ReadEdges(const FrameList& list, const Camera& camera, const FrameReaderOptions& options,
                     const std::function<void(double)>& progress) {
  const Rectifier rectifier(camera);
  const std::size_t stride =
      std::max<std::size_t>(1, (list.frames.size() + options.max_frames - 1) / options.max_frames);
  const int n = static_cast<int>((list.frames.size() + stride - 1) / stride);
  EdgeDetectorOptions detector = options.edges;
  if (options.find_contrast) {
    detector.sure_contrast = FindContrast(list, camera, rectifier, options);
    detector.min_contrast = detector.sure_contrast / 2;
  }
  std::vector<std::vector<EdgePixel>> edges(n);
  std::mutex mutex;  // of progress
  int done = 0;
  ParallelFor(n, options.threads, [&](int k) {
    const cv::Mat image = rectifier.Rectify(ReadGrey(list.frames[k * stride].path, camera));
    edges[k] = DetectEdges(image, rectifier.valid(), detector);
    const std::lock_guard<std::mutex> lock(mutex);
    progress(++done / static_cast<double>(n));
  });
  std::vector<std::size_t> counts;
  counts.reserve(edges.size());
  for (const auto& e : edges) counts.push_back(e.size());
  std::sort(counts.begin(), counts.end());
  const std::size_t least =
      counts.empty()
          ? 0
          : std::max(kLeastEdges, static_cast<std::size_t>(options.min_share_of_edges *
                                                           static_cast<double>(counts[counts.size() / 2])));
  ReadFrames result;
  result.read = static_cast<std::size_t>(n);
  result.contrast = detector.sure_contrast;
  for (int k = 0; k < n; ++k) {
    if (edges[k].size() < least) {
      ++result.poor;
      continue;
    }
    const Camera& pinhole = rectifier.camera();
    result.views.push_back({list.frames[k * stride].T_map_camera, pinhole,
                            EdgeImage(pinhole.width, pinhole.height, std::move(edges[k]), true)});
    result.stamps.push_back(list.frames[k * stride].t);
  }
  if (result.views.size() < 3) {
    throw std::runtime_error(list.frames.front().path + " and the others: " +
                             std::to_string(result.views.size()) + " of " + std::to_string(result.read) +
                             " pictures show edges, a map needs three; the lens was covered, it was dark, or "
                             "there is no texture (--contrast lowers what counts as an edge)");
  }
  return result;
}

}  // namespace evit::mapping
