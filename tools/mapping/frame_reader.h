#pragma once

#include <cstddef>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/mapping/edge_detector.h"
#include "common/mapping/posed_edges.h"
#include "tools/formats/frames/decode_picture.h"
#include "tools/mapping/frame_list.h"

namespace evit::mapping {

struct FrameReaderOptions {
  EdgeDetectorOptions edges;
  bool find_contrast = true;        // lower edges.sure_contrast where pictures show few edges with it
  std::size_t max_frames = 400;     // of more, every n-th is read: a map needs the views, not the rate
  double min_share_of_edges = 0.3;  // of the median frame's; fewer: blurred, dark or covered
  int threads = 2;
};

struct ReadFrames {
  std::vector<PosedEdges> views;
  std::vector<Utime> stamps;         // of each
  std::vector<std::size_t> indices;  // of each, in its source
  std::size_t read = 0;
  std::size_t poor = 0;          // left out: blurred, dark, covered, or nothing to see
  std::size_t unreadable = 0;    // left out: damaged or cut off,
  std::string first_unreadable;  // this and why
  double contrast = 0;           // that edges were asked for; 0: none was looked for
  bool mosaic = false;           // pictures were the raw mosaic of a colour sensor
};

/// What some pictures, spread over `chosen`, say of all.
formats::PictureStyle FindStyle(formats::FrameSource* source, const std::vector<std::size_t>& chosen);

/// Decodes pictures by several threads and calls work(k, picture) for the k-th of `chosen`, in any order.
/// What decoding throws goes to unreadable(k, what).
void VisitPictures(formats::FrameSource* source, const std::vector<std::size_t>& chosen,
                   const formats::PictureStyle& style, int threads,
                   const std::function<void(std::size_t, const cv::Mat&)>& work,
                   const std::function<void(std::size_t, const std::string&)>& unreadable);

/// Reads pictures, takes out the lens distortion and finds their edges. Throws std::runtime_error naming the
/// picture: of another size than the camera's; and where fewer than three can be read and show edges.
ReadFrames ReadEdges(const FrameList& list, formats::FrameSource* source, const Camera& camera,
                     const FrameReaderOptions& options, const std::function<void(double)>& progress);

}  // namespace evit::mapping
