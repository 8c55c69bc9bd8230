#include "common/tracking/start_probation.h"

#include <algorithm>

#include "common/tracking/alignment_significance.h"

namespace evit {
namespace {

constexpr Utime kLasts = 1'000'000;     // us
constexpr int kFewest = 5, kMean = 10;  // keyframes

}  // namespace

void StartProbation::Begin(Utime t) {
  began_ = t;
  mean_significance_ = n_ = 0;
  passed_ = false;
}

void StartProbation::Skip() {
  began_ = 0;
  passed_ = true;
}

void StartProbation::Add(double significance) {
  n_ = std::min(n_ + 1, kMean);
  mean_significance_ += (significance - mean_significance_) / n_;
  if (n_ >= kFewest && mean_significance_ >= kFollowSignificance) passed_ = true;
}

std::string StartProbation::WhyFalse(Utime t) const {
  const bool over = began_ == 0 || t - began_ > kLasts;
  if (over || n_ < kFewest || mean_significance_ >= kFollowSignificance) return "";
  return "the map lies on the events no better than at a false pose";
}

}  // namespace evit
