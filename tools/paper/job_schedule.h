#pragma once

#include <cstddef>
#include <vector>

#include "tools/paper/paper_job.h"

namespace evit::paper {

/// Which jobs are done, which run and which may begin.
class JobSchedule {
 public:
  enum class State { kWaiting, kRunning, kDone, kFailed };

  /// Jobs whose result exists already are kept. `jobs` must outlive this.
  explicit JobSchedule(const std::vector<PaperJob>& jobs);

  /// The next job that can begin; the number of jobs where there is none. What needs a failed job fails too.
  std::size_t TakeNext();
  void Set(std::size_t k, State state);

  /// Jobs that were done before.
  std::size_t kept() const { return kept_; }
  /// Jobs that are done or failed by now.
  std::size_t finished() const;
  std::size_t size() const { return jobs_.size(); }
  /// Share 0..1 of the work, where `running` (s of cost) of what runs is done.
  double Share(double running) const { return total_ > 0 ? (finished_cost_ + running) / total_ : 1; }

 private:
  const std::vector<PaperJob>& jobs_;
  std::vector<State> states_;
  std::size_t kept_ = 0;
  double total_ = 0, finished_cost_ = 0;  // s
};

}  // namespace evit::paper
