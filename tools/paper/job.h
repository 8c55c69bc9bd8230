#pragma once

#include <functional>
#include <string>
#include <vector>

namespace evit::paper {

/// A piece of work whose result is a folder: programs run one after the other. It is done once, and again
/// only when its key changes.
struct PaperJob {
  using Commands = std::vector<std::vector<std::string>>;

  std::string id;                     // for people, e.g. "run sofa_fast.10s.1 evit"
  std::string folder;                 // its own: removed before it begins
  std::string key;                    // everything the result depends on, as text
  double cost = 1;                    // s it takes, roughly: for the estimate
  std::vector<std::size_t> needs;     // jobs (by index) that must be done before
  std::vector<int> good_codes{0};     // exit codes that are a result
  std::function<Commands()> prepare;  // in the fresh folder; returns what to run
  std::function<void()> finish;       // after the last program; may be empty
};

/// True where the folder holds the result of this very key.
bool IsDone(const PaperJob& job);
/// Marks it done: the last thing that is written.
void MarkDone(const PaperJob& job);

struct JobsOutcome {
  std::size_t done = 0, kept = 0;  // kept: were there already
  bool interrupted = false;
  struct Failure {
    std::string id, words;
  };
  std::vector<Failure> failures;  // with the programs' last words; jobs that needed them were left out
};

/// Does all jobs that are not done yet, up to `parallel` at once, in order as far as their needs allow.
/// `programs`: folder of executables searched before PATH. `show`: share 0..1 of the work, and what is
/// running; called some ten times a second. Once `interrupted` returns true, running jobs are stopped and
/// their folders removed; everything finished stays. A job that fails does not stop the others.
JobsOutcome RunJobs(const std::vector<PaperJob>& jobs, int parallel, const std::string& programs,
                    const std::function<void(double, const std::string&)>& show,
                    const std::function<bool()>& interrupted);

}  // namespace evit::paper
