#include "services/window_optimizer/load_governor.h"

#include <algorithm>

namespace evit {
namespace {

constexpr double kLateMs = 15;  // most of the time between two keyframes at their highest rate
constexpr double kIdleMs = 5;
constexpr int kLateKeyframes = 5;  // more late than in time: a step's effect must show before the next
constexpr int kIdleKeyframes = 100;
constexpr double kLeastBudget = 0.015, kMostBudget = 0.1;  // s: of one solve
constexpr double kBudgetShare = 0.6;                       // of the time between keyframes

}  // namespace

double LoadGovernor::SolveBudget(double interval, bool others_wait) {
  return others_wait ? kLeastBudget : std::clamp(kBudgetShare * interval, kLeastBudget, kMostBudget);
}

void LoadGovernor::Observe(double waited_ms) {
  late_ = waited_ms > kLateMs ? late_ + 1 : std::max(late_ - 1, 0);
  idle_ = waited_ms < kIdleMs ? idle_ + 1 : 0;
  if (late_ >= kLateKeyframes && level_ < kMaxLevel) {
    ++level_;
    late_ = 0;
  }
  if (idle_ >= kIdleKeyframes && level_ > 0) {
    --level_;
    idle_ = 0;
  }
}

}  // namespace evit
