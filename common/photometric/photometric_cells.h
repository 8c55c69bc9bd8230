#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "common/map/photometric_map.h"
#include "common/photometric/photometric_view.h"
#include "common/photometric/splats.h"

namespace evit {

/// A photometric map sorted into cubes, so that what is out of view is passed over a cube at a time.
class PhotometricCells {
 public:
  explicit PhotometricCells(const PhotometricMap& map);

  /// The points in view, a pixel around the image included, cell by cell: those of the part-th of `parts`
  /// equal shares of the map. The camera must have no distortion.
  void Project(const ViewQuery& query, std::size_t part, std::size_t parts, Splats* splats) const;

  std::size_t size() const { return n_; }
  /// m: side of the square of surface that a point stands for, median.
  float spacing() const { return spacing_; }

 private:
  struct Cell {
    Eigen::Vector3f center;
    float radius;            // m
    std::size_t begin, end;  // points
  };
  std::size_t n_ = 0;
  float spacing_ = 0;
  std::vector<Cell> cells_;
  std::vector<float> x_, y_, z_, intensity_;  // cell by cell, and a block of lanes more
};

}  // namespace evit
