#include "tools/paper/job_schedule.h"

#include <algorithm>

namespace evit::paper {

JobSchedule::JobSchedule(const std::vector<PaperJob>& jobs)
    : jobs_(jobs), states_(jobs.size(), State::kWaiting) {
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (IsDone(jobs[k])) {
      states_[k] = State::kDone;
      ++kept_;
    } else {
      total_ += jobs[k].cost;
    }
  }
}

std::size_t JobSchedule::TakeNext() {
  for (std::size_t k = 0; k < jobs_.size(); ++k) {
    if (states_[k] != State::kWaiting) continue;
    const auto any = [&](State state) {
      return std::any_of(jobs_[k].needs.begin(), jobs_[k].needs.end(),
                         [&](std::size_t n) { return states_[n] == state; });
    };
    if (any(State::kFailed)) {
      Set(k, State::kFailed);
    } else if (!any(State::kWaiting) && !any(State::kRunning)) {
      Set(k, State::kRunning);
      return k;
    }
  }
  return jobs_.size();
}

void JobSchedule::Set(std::size_t k, State state) {
  states_[k] = state;
  if (state == State::kDone || state == State::kFailed) finished_cost_ += jobs_[k].cost;
}

std::size_t JobSchedule::finished() const {
  return static_cast<std::size_t>(std::count_if(
      states_.begin(), states_.end(), [](State s) { return s == State::kDone || s == State::kFailed; }));
}

}  // namespace evit::paper
