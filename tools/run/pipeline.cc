#include "tools/run/pipeline.h"

#include <stdexcept>

namespace evit::run {
namespace {

constexpr int kMaxEarlyDeaths = 7;  // in a row: 10, 20 ... 1000 ms between them, some 2 s in all

}  // namespace

Pipeline::Pipeline(Bus* bus, const std::string& deputy, const std::vector<procman::ProcmanCommand>& services,
                   const std::string& programs, const std::string& logs)
    : deputy_(bus, deputy, services, {programs, logs}),
      processes_(deputy_.supervisor().processes()),
      runs_(services.size(), 1) {
  for (const procman::ProcmanCommand& service : services) deputy_.supervisor().Start(service.id);
}

void Pipeline::Watch() {
  deputy_.Tick();
  for (std::size_t k = 0; k < processes_.size(); ++k) {
    const procman::ManagedProcess& process = *processes_[k];
    const bool waiting = process.state() == procman::ManagedProcess::State::kWaiting;
    // Ordered restarts (evit restart) are not deaths.
    if (waiting && process.died() && process.runs() == runs_[k]) {
      deaths_.push_back({process.command().id, std::chrono::steady_clock::now()});
      ++runs_[k];
    }
    if (!waiting && process.runs() > runs_[k]) runs_[k] = process.runs();
    const bool given_up = process.early_deaths() >= kMaxEarlyDeaths;
    if (!process.died() || (waiting && !given_up)) continue;
    const std::string words = process.LastWords();
    throw std::runtime_error(process.command().id + " died with " + process.end() +
                             (words.empty() ? " without any output" : "; its last output:" + words));
  }
}

}  // namespace evit::run
