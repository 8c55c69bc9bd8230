#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "procman/managed_process.h"
#include "tools/paper/paper_job.h"

namespace evit::paper {

/// One job at work: its programs run one after the other, without blocking.
class JobWorker {
 public:
  /// Prepares the job in a fresh folder. `index`: of the job, for the caller. `programs`: folder of
  /// executables searched before PATH. `job` must outlive this. Throws where the preparation fails.
  JobWorker(const PaperJob* job, std::size_t index, std::string programs);

  enum class State { kRunning, kDone, kFailed };

  /// Call often: starts the next program when one has ended. Throws where it cannot be started, or the job's
  /// finish() fails.
  State Tick();

  /// Stops what runs and removes the folder.
  void Abandon();

  const PaperJob& job() const { return *job_; }
  std::size_t index() const { return index_; }
  /// Why it failed, with the program's last output.
  const std::string& failure() const { return failure_; }
  /// 0..1 of the work.
  double share() const;

 private:
  bool Succeeded() const;
  void StartNext();

  const PaperJob* job_;
  std::size_t index_;
  std::string programs_, failure_;
  PaperJob::Commands commands_;
  std::size_t next_ = 0;
  double share_ = 0;  // of the program that runs
  std::unique_ptr<procman::ManagedProcess> process_;
};

}  // namespace evit::paper
