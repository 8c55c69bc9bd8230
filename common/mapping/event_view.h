#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "common/events/event.h"
#include "common/mapping/posed_edges.h"
#include "common/mapping/rectifier.h"

namespace evit {

struct EventViewOptions {
  double blur_sigma_px = 1.0;  // of the warped events before ridges are looked for
  double min_events = 0.3;     // of a ridge, per pixel of its length: along a line that has
  double sure_events = 0.7;    // as many somewhere
  int min_length = 8;          // pixels of a connected line; shorter ones are specks
  int max_per_pixel = 3;       // events of a pixel and polarity that count: more tell of the pixel
  double min_sweep_px = 1.0;   // by which an edge has to move across itself to show
};

/// The events of a short time, and where the camera was meanwhile.
struct EventSlice {
  EventArray events;  // in [begin, end)
  Utime begin = 0, end = 0;
  std::vector<SE3> T_map_camera;  // at an odd number of instants, begin and end and evenly between
};

/// Sees the edges in events: those of a short time, moved to where they would have been in its middle (the
/// camera's motion is known; things are taken to be `depth` away, and a few pixels of motion forgive that),
/// lie on ridges, one of each polarity. A ridge is an edge: its place across to a fraction of a pixel from
/// the ridge's curvature (C. Steger, "An unbiased detector of curvilinear structures", 1998), its brighter
/// side from polarity and the direction of the motion. Nothing is known of its contrast.
class EventView {
 public:
  /// `camera`: the event camera, with its distortion.
  EventView(const Camera& camera, const EventViewOptions& options);

  /// As from the middle of the slice; the same for the same input.
  PosedEdges Make(const EventSlice& slice, double depth) const;

  /// The camera without distortion that views have.
  const Camera& camera() const { return rectifier_.camera(); }

 private:
  struct Warped;
  Warped Warp(const EventSlice& slice, double depth) const;
  void AddRidges(const cv::Mat& warped, double sign, const CameraSweep& sweep, double depth,
                 std::vector<EdgePixel>* edges) const;

  Camera distorted_;
  EventViewOptions options_;
  Rectifier rectifier_;
  std::vector<Eigen::Vector3f> rays_;  // of each pixel, z == 1; z == 0: the lens has none
};

}  // namespace evit
