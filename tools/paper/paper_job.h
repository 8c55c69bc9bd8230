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

}  // namespace evit::paper
