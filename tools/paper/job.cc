#include "tools/paper/job.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "procman/managed_process.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

constexpr char kKeyFile[] = "/key.txt";

// The last percentage in what a program says of its progress ("tracking: 30 % ..."); -1: none.
double ShareIn(const std::string& text) {
  const std::size_t at = text.rfind(" %");
  if (at == std::string::npos || at == 0) return -1;
  std::size_t begin = at;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(text[begin - 1])) != 0) --begin;
  return begin == at ? -1 : std::min(1.0, std::atof(text.substr(begin, at - begin).c_str()) / 100);
}

// One job at work.
class Worker {
 public:
  Worker(const PaperJob* job, std::size_t index, std::string programs)
      : job_(job), index_(index), programs_(std::move(programs)) {
    std::filesystem::remove_all(job->folder);
    MakeFolder(job->folder);
    commands_ = job->prepare();
  }

  enum class State { kRunning, kDone, kFailed };

  // Starts the next program where one has ended. Throws where it cannot be started, or finish() fails.
  State Tick() {
    if (process_ != nullptr) {
      process_->Tick();
      if (process_->running()) return State::kRunning;
      const auto& good = job_->good_codes;
      if (std::find(good.begin(), good.end(), process_->exit_code()) == good.end()) {
        words_ = process_->end() + ": " + process_->LastWords();
        return State::kFailed;
      }
      process_.reset();
      ++next_;
      share_ = 0;
    }
    if (next_ == commands_.size()) {
      if (job_->finish) job_->finish();
      MarkDone(*job_);
      return State::kDone;
    }
    procman::ProcmanCommand command;
    const auto& words = commands_[next_];
    command.id = words.size() > 1 ? words[1] : "program";
    if (command.id.find_first_of("/-") != std::string::npos) command.id = "program";
    command.exec = procman::JoinCommandLine(words);
    command.stop_time_allowed = 5;
    process_ = std::make_unique<procman::ManagedProcess>(
        command, procman::ManagedProcess::Places{programs_, job_->folder},
        [this](const std::string&, const std::string& text) { share_ = std::max(share_, ShareIn(text)); });
    process_->Start();
    return State::kRunning;
  }

  void Abandon() {
    if (process_ != nullptr) {
      process_->Stop();
      while (process_->running()) {
        process_->Tick();
        usleep(10'000);
      }
    }
    std::error_code ignored;
    std::filesystem::remove_all(job_->folder, ignored);
  }

  const PaperJob& job() const { return *job_; }
  std::size_t index() const { return index_; }
  const std::string& words() const { return words_; }
  double share() const {
    return (static_cast<double>(next_) + share_) /
           static_cast<double>(std::max<std::size_t>(1, commands_.size()));
  }

 private:
  const PaperJob* job_;
  std::size_t index_;
  std::string programs_, words_;
  PaperJob::Commands commands_;
  std::size_t next_ = 0;
  double share_ = 0;
  std::unique_ptr<procman::ManagedProcess> process_;
};

class Schedule {
 public:
  enum class State { kWaiting, kRunning, kDone, kFailed };

  explicit Schedule(const std::vector<PaperJob>& jobs) : jobs_(jobs), states_(jobs.size(), State::kWaiting) {
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      if (IsDone(jobs[k])) {
        states_[k] = State::kDone;
        ++kept_;
      } else {
        total_ += jobs[k].cost;
      }
    }
  }

  // The next job that can begin; jobs.size() where there is none. What needs a failed one fails with it.
  std::size_t Next() {
    for (std::size_t k = 0; k < jobs_.size(); ++k) {
      if (states_[k] != State::kWaiting) continue;
      const auto any = [&](State state) {
        return std::any_of(jobs_[k].needs.begin(), jobs_[k].needs.end(),
                           [&](std::size_t n) { return states_[n] == state; });
      };
      if (any(State::kFailed)) {
        Set(k, State::kFailed);
      } else if (!any(State::kWaiting) && !any(State::kRunning)) {
        return k;
      }
    }
    return jobs_.size();
  }

  void Set(std::size_t k, State state) {
    states_[k] = state;
    if (state == State::kDone || state == State::kFailed) finished_ += jobs_[k].cost;
  }

  double Share(const std::vector<std::unique_ptr<Worker>>& workers) const {
    double cost = finished_;
    for (const auto& w : workers) cost += w->share() * w->job().cost;
    return total_ > 0 ? cost / total_ : 1;
  }
  std::size_t kept() const { return kept_; }
  std::string Note(const std::vector<std::unique_ptr<Worker>>& workers) const {
    const auto done = std::count_if(states_.begin(), states_.end(),
                                    [](State s) { return s == State::kDone || s == State::kFailed; });
    std::string text = std::to_string(done) + "/" + std::to_string(jobs_.size());
    for (const auto& w : workers) text += (w == workers.front() ? ": " : ", ") + w->job().id;
    return text;
  }

 private:
  const std::vector<PaperJob>& jobs_;
  std::vector<State> states_;
  std::size_t kept_ = 0;
  double total_ = 0, finished_ = 0;  // s
};

}  // namespace

bool IsDone(const PaperJob& job) {
  const std::string path = job.folder + kKeyFile;
  return std::filesystem::exists(path) && ReadText(path) == job.key;
}

void MarkDone(const PaperJob& job) { WriteText(job.folder + kKeyFile, job.key); }

JobsOutcome RunJobs(const std::vector<PaperJob>& jobs, int parallel, const std::string& programs,
                    const std::function<void(double, const std::string&)>& show,
                    const std::function<bool()>& interrupted) {
  JobsOutcome outcome;
  Schedule schedule(jobs);
  outcome.kept = schedule.kept();
  std::vector<std::unique_ptr<Worker>> workers;
  const auto fail = [&](std::size_t k, const std::string& words) {
    schedule.Set(k, Schedule::State::kFailed);
    outcome.failures.push_back({jobs[k].id, words});
  };
  while (true) {
    if (interrupted()) {
      for (const auto& worker : workers) worker->Abandon();
      outcome.interrupted = true;
      return outcome;
    }
    while (static_cast<int>(workers.size()) < parallel) {
      const std::size_t next = schedule.Next();
      if (next == jobs.size()) break;
      schedule.Set(next, Schedule::State::kRunning);
      try {
        workers.push_back(std::make_unique<Worker>(&jobs[next], next, programs));
      } catch (const std::exception& error) {
        fail(next, error.what());
      }
    }
    if (workers.empty()) break;
    for (auto it = workers.begin(); it != workers.end();) {
      const std::size_t index = (*it)->index();
      Worker::State state = Worker::State::kFailed;
      std::string words;
      try {
        state = (*it)->Tick();
        words = (*it)->words();
      } catch (const std::exception& error) {
        words = error.what();
      }
      if (state == Worker::State::kRunning) {
        ++it;
        continue;
      }
      if (state == Worker::State::kFailed) {
        fail(index, words);
      } else {
        schedule.Set(index, Schedule::State::kDone);
        ++outcome.done;
      }
      it = workers.erase(it);
    }
    show(schedule.Share(workers), schedule.Note(workers));
    usleep(50'000);
  }
  show(1, "");
  return outcome;
}

}  // namespace evit::paper
