#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/paper/paper_job.h"

namespace evit::paper {

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
