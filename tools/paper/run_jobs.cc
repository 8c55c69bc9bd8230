#include "tools/paper/run_jobs.h"

#include <unistd.h>

#include <memory>
#include <stdexcept>

#include "tools/paper/job_schedule.h"
#include "tools/paper/job_worker.h"

namespace evit::paper {

namespace {

using Workers = std::vector<std::unique_ptr<JobWorker>>;

double Share(const JobSchedule& schedule, const Workers& workers) {
  double running = 0;
  for (const auto& worker : workers) running += worker->share() * worker->job().cost;
  return schedule.Share(running);
}

// "3/8: run sofa_fast evit, run sofa_fast evt".
std::string Note(const JobSchedule& schedule, const Workers& workers) {
  std::string text = std::to_string(schedule.finished()) + "/" + std::to_string(schedule.size());
  for (const auto& worker : workers) text += (worker == workers.front() ? ": " : ", ") + worker->job().id;
  return text;
}

}  // namespace

JobsOutcome RunJobs(const std::vector<PaperJob>& jobs, int parallel, const std::string& programs,
                    const std::function<void(double, const std::string&)>& show,
                    const std::function<bool()>& interrupted) {
  JobsOutcome outcome;
  JobSchedule schedule(jobs);
  outcome.kept = schedule.kept();
  Workers workers;
  const auto fail = [&](std::size_t k, const std::string& words) {
    schedule.Set(k, JobSchedule::State::kFailed);
    outcome.failures.push_back({jobs[k].id, words});
  };
  const auto start = [&] {
    while (static_cast<int>(workers.size()) < parallel) {
      const std::size_t next = schedule.TakeNext();
      if (next == jobs.size()) return;
      try {
        workers.push_back(std::make_unique<JobWorker>(&jobs[next], next, programs));
      } catch (const std::exception& error) {
        fail(next, error.what());
      }
    }
  };
  // Whether the worker still runs.
  const auto tick = [&](JobWorker* worker) {
    try {
      switch (worker->Tick()) {
        case JobWorker::State::kRunning:
          return true;
        case JobWorker::State::kFailed:
          fail(worker->index(), worker->failure());
          break;
        case JobWorker::State::kDone:
          schedule.Set(worker->index(), JobSchedule::State::kDone);
          ++outcome.done;
      }
    } catch (const std::exception& error) {
      fail(worker->index(), error.what());
    }
    return false;
  };
  while (true) {
    if (interrupted()) {
      for (const auto& worker : workers) worker->Abandon();
      outcome.interrupted = true;
      return outcome;
    }
    start();
    if (workers.empty()) break;
    for (auto it = workers.begin(); it != workers.end();) it = tick(it->get()) ? it + 1 : workers.erase(it);
    show(Share(schedule, workers), Note(schedule, workers));
    usleep(50'000);
  }
  show(1, "");
  return outcome;
}

}  // namespace evit::paper
