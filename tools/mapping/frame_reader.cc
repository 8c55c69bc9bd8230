#include "tools/mapping/frame_reader.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "common/mapping/rectifier.h"
#include "common/parallel/parallel_for.h"
#include "tools/formats/frames/picture_style.h"

namespace evit::mapping {
namespace {

constexpr std::size_t kLeastEdges = 200;  // of a frame that shows something
constexpr std::size_t kSamples = 9;       // pictures that the contrast of edges is found from
constexpr double kLeastContrast = 0.12;   // of edges: below it, noise looks like them

void RequireSize(const cv::Mat& image, const Camera& camera, const std::string& name) {
  if (image.cols == camera.width && image.rows == camera.height) return;
  throw std::runtime_error(name + ": is " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                           ", but the camera file says " + std::to_string(camera.width) + "x" +
                           std::to_string(camera.height) +
                           "; give the calibration of this camera, scaled to the pictures' size");
}

// Spread evenly over all.
std::vector<std::size_t> Samples(const std::vector<std::size_t>& indices) {
  const std::size_t n = std::min(kSamples, indices.size());
  std::vector<std::size_t> samples;
  for (std::size_t k = 0; k < n; ++k) samples.push_back(indices[(2 * k + 1) * indices.size() / (2 * n)]);
  return samples;
}

// Cameras compress contrast by their gamma, and rooms differ: as low as it takes for a middling picture to
// show edges as long as two and a quarter times around it.
double FindContrast(const std::vector<std::size_t>& samples, const formats::PictureStyle& style,
                    formats::FrameSource* source, const Camera& camera, const Rectifier& rectifier,
                    const FrameReaderOptions& options) {
  const std::size_t n = samples.size();
  std::vector<cv::Mat> images(n);
  VisitPictures(
      source, samples, style, options.threads,
      [&](std::size_t k, const cv::Mat& image) {
        RequireSize(image, camera, source->frames()[samples[k]].name);
        images[k] = rectifier.Rectify(image);
      },
      [](std::size_t, const std::string&) {});
  const auto enough = static_cast<std::size_t>(4.5 * (camera.width + camera.height));
  double contrast = options.edges.sure_contrast;
  for (; contrast > kLeastContrast; contrast = std::max(kLeastContrast, 0.7 * contrast)) {
    EdgeDetectorOptions detector = options.edges;
    detector.sure_contrast = contrast, detector.min_contrast = contrast / 2;
    std::vector<std::size_t> counts(n);
    ParallelFor(static_cast<int>(n), options.threads, [&](int k) {
      counts[k] = images[k].empty() ? 0 : DetectEdges(images[k], rectifier.valid(), detector).size();
    });
    std::sort(counts.begin(), counts.end());
    if (n == 0 || counts[counts.size() / 2] >= enough) break;
  }
  return contrast;
}

// Fewer edges than this, and a picture is blurred, dark or covered.
std::size_t LeastEdges(const std::vector<std::vector<EdgePixel>>& edges, double share) {
  std::vector<std::size_t> counts;
  counts.reserve(edges.size());
  for (const auto& e : edges) counts.push_back(e.size());
  std::sort(counts.begin(), counts.end());
  if (counts.empty()) return 0;
  return std::max(kLeastEdges,
                  static_cast<std::size_t>(share * static_cast<double>(counts[counts.size() / 2])));
}

}  // namespace

formats::PictureStyle FindStyle(formats::FrameSource* source, const std::vector<std::size_t>& chosen) {
  std::vector<formats::StoredPicture> stored;
  for (const std::size_t k : Samples(chosen)) {
    try {
      stored.push_back(source->Fetch(k));
    } catch (const std::runtime_error&) {
      continue;  // counted where all are read
    }
  }
  return formats::StyleOf(stored);
}

void VisitPictures(formats::FrameSource* source, const std::vector<std::size_t>& chosen,
                   const formats::PictureStyle& style, int threads,
                   const std::function<void(std::size_t, const cv::Mat&)>& work,
                   const std::function<void(std::size_t, const std::string&)>& unreadable) {
  const std::size_t at_once = 4 * static_cast<std::size_t>(threads);
  std::mutex mutex;  // of unreadable
  std::vector<formats::StoredPicture> stored;
  for (std::size_t begin = 0; begin < chosen.size(); begin += at_once) {
    const std::size_t n = std::min(at_once, chosen.size() - begin);
    stored.assign(n, {});
    for (std::size_t k = 0; k < n; ++k) {
      try {
        stored[k] = source->Fetch(chosen[begin + k]);
      } catch (const std::runtime_error& error) {
        unreadable(begin + k, error.what());
      }
    }
    ParallelFor(static_cast<int>(n), threads, [&](int k) {
      if (stored[k].bytes.empty() && stored[k].encoding.empty()) return;  // as told above
      cv::Mat image;
      try {
        image = formats::DecodeGrey(stored[k], source->frames()[chosen[begin + k]].name, style);
      } catch (const std::runtime_error& error) {
        const std::lock_guard<std::mutex> lock(mutex);
        unreadable(begin + k, error.what());
        return;
      }
      work(begin + k, image);
    });
  }
}

ReadFrames ReadEdges(const FrameList& list, formats::FrameSource* source, const Camera& camera,
                     const FrameReaderOptions& options, const std::function<void(double)>& progress) {
  const Rectifier rectifier(camera);
  const std::size_t stride =
      std::max<std::size_t>(1, (list.frames.size() + options.max_frames - 1) / options.max_frames);
  std::vector<Frame> frames;
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < list.frames.size(); k += stride) {
    frames.push_back(list.frames[k]);
    indices.push_back(list.frames[k].index);
  }
  const formats::PictureStyle style = FindStyle(source, indices);
  EdgeDetectorOptions detector = options.edges;
  if (options.find_contrast) {
    detector.sure_contrast = FindContrast(Samples(indices), style, source, camera, rectifier, options);
    detector.min_contrast = detector.sure_contrast / 2;
  }
  ReadFrames result;
  std::vector<std::vector<EdgePixel>> edges(frames.size());
  std::mutex mutex;  // of progress
  std::size_t done = 0;
  VisitPictures(
      source, indices, style, options.threads,
      [&](std::size_t k, const cv::Mat& image) {
        RequireSize(image, camera, source->frames()[indices[k]].name);
        edges[k] = DetectEdges(rectifier.Rectify(image), rectifier.valid(), detector);
        const std::lock_guard<std::mutex> lock(mutex);
        progress(static_cast<double>(++done) / static_cast<double>(frames.size()));
      },
      [&](std::size_t, const std::string& why) {
        if (result.unreadable++ == 0) result.first_unreadable = why;
      });
  if (result.unreadable == frames.size()) throw std::runtime_error(result.first_unreadable);
  const std::size_t least = LeastEdges(edges, options.min_share_of_edges);
  result.read = frames.size();
  result.contrast = detector.sure_contrast;
  result.mosaic = style.mosaic;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (edges[k].size() < least) {
      ++result.poor;
      continue;
    }
    const Camera& pinhole = rectifier.camera();
    result.views.push_back({frames[k].T_map_camera, pinhole,
                            EdgeImage(pinhole.width, pinhole.height, std::move(edges[k]), true)});
    result.stamps.push_back(frames[k].t);
    result.indices.push_back(frames[k].index);
  }
  result.poor -= result.unreadable;
  if (result.views.size() < 3) {
    throw std::runtime_error(source->frames()[indices.front()].name + " and the others: " +
                             std::to_string(result.views.size()) + " of " + std::to_string(result.read) +
                             " pictures show edges, a map needs three; the lens was covered, it was dark or "
                             "blurred, or there is no texture (--contrast lowers what counts as an edge)");
  }
  return result;
}

}  // namespace evit::mapping
