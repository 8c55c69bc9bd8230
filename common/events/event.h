#pragma once

#include <cstdint>
#include <vector>

#include "common/time/utime.h"

namespace evit {

/// Consecutive events, sorted by time, as a struct of arrays (all of one length).
struct EventArray {
  std::vector<Utime> t;          // us
  std::vector<std::uint16_t> x;  // pixel column
  std::vector<std::uint16_t> y;  // pixel row
  std::vector<std::uint8_t> p;   // 1 brighter, 0 darker

  std::size_t size() const { return t.size(); }
  void clear() { t.clear(), x.clear(), y.clear(), p.clear(); }
  void push_back(Utime time, std::uint16_t column, std::uint16_t row, std::uint8_t polarity) {
    t.push_back(time), x.push_back(column), y.push_back(row), p.push_back(polarity);
  }
};

}  // namespace evit
