#pragma once

#include <string>
#include <vector>

#include "tools/locate/search_trace.h"

namespace evit::locate {

/// Counts what came of many starts.
class StartTally {
 public:
  /// `right`: the pose at the first TRACKING was.
  void Add(const LocatorResult& result, bool right, Claim at_once = Claim::kNone);

  int wrong() const { return wrong_; }
  /// "starts N right N within_2s N wrong N withdrawn N cut N after_s X candidates X events_per_s X search_s X
  /// cpu_s X at_once_right N at_once_wrong N": of those found the median sensor time; of all the means of the
  /// candidates of the first search, of the events' rate, of one search and of the CPU time; in the end what
  /// would have been claimed from single keyframes (AtOnce). For scripts.
  std::string Line() const;

 private:
  int starts_ = 0, right_ = 0, within_ = 0, wrong_ = 0, withdrawn_ = 0, cut_ = 0;
  double candidates_ = 0, rate_ = 0, search_ = 0, cpu_ = 0;  // sums
  int at_once_right_ = 0, at_once_wrong_ = 0;
  std::vector<double> after_;  // s, of those found
};

}  // namespace evit::locate
