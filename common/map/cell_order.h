#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace evit {

/// Points in the order of the cubic cells that they lie in: cells by x, then y, then z, points of a cell by
/// index.
class CellOrder {
 public:
  using Cell = std::array<std::int64_t, 3>;
  struct Place {
    std::uint64_t key;   // of the point's cell
    std::int32_t index;  // of the point
  };

  /// `side`: of a cell, m. Points a million cells from the origin and beyond share the last cell.
  CellOrder(const std::vector<Eigen::Vector3f>& points, double side);

  std::size_t size() const { return places_.size(); }
  const Place& operator[](std::size_t k) const { return places_[k]; }
  /// Place after the last point of the cell of place k.
  std::size_t EndOfCell(std::size_t k) const;

  Cell CellOf(const Eigen::Vector3f& p) const;
  /// Of a cell that holds points or is next to one: ascending as cells come, so that neighbours along z have
  /// neighbouring keys.
  std::uint64_t KeyOf(const Cell& cell) const;

 private:
  void Sort();

  double inverse_side_;
  Cell least_{};  // of the cells that hold points, by axis
  std::vector<Place> places_;
};

}  // namespace evit
