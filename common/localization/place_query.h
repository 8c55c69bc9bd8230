#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/time/utime.h"

namespace evit {

/// What a robot may know of where it is. Of the body, in the map frame; what is not given is open.
struct PlacePrior {
  struct Near {
    Eigen::Vector3d position;  // m
    double radius;             // m
  };
  struct Between {
    double low, high;
  };
  struct Heading {
    double yaw, tolerance;  // rad: of the body's x axis over the map's, about the vertical
  };
  std::optional<Near> near;
  std::optional<Between> height;  // m
  std::optional<Heading> heading;

  bool open() const { return !near && !height && !heading; }
  /// `slack`: m by which positions may be off. `slack_yaw`: rad.
  bool Allows(const SE3& T_map_body, double slack, double slack_yaw) const;
};

/// Where in the map may this keyframe have been seen from?
struct PlaceQuery {
  std::int64_t number = 0;                             // of the question
  Utime t = 0;                                         // us, of the keyframe
  cv::Mat surface;                                     // CV_8UC1, negated time surface
  Eigen::Vector3d up_body = Eigen::Vector3d::UnitZ();  // unit: which way is up, body frame
  bool everywhere = true;                              // look in the whole map, else around `hypotheses`
  std::vector<SE3> hypotheses;                         // T_map_body: predicted poses, to be refined
  PlacePrior prior;                                    // for looking everywhere
};

/// A pose that explains a view, refined.
struct PlaceCandidate {
  SE3 T_map_body;
  double significance = 0;  // of the alignment (AlignmentSignificance); likely above 5, chance below 4.5
  double likeness = 0;      // of the panoramas, standard deviations (PlaceMatch); 0 for a refined hypothesis
  int n_points = 0;         // of the map, that it was aligned by
};

}  // namespace evit
