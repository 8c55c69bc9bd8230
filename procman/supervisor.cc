#include "procman/supervisor.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace evit::procman {

Supervisor::Supervisor(const std::vector<ProcmanCommand>& commands, const ManagedProcess::Places& places,
                       const ManagedProcess::Sink& sink) {
  for (const ProcmanCommand& command : commands) {
    processes_.push_back(std::make_unique<ManagedProcess>(command, places, sink));
  }
}

ManagedProcess* Supervisor::Find(const std::string& id) {
  const auto it = std::find_if(processes_.begin(), processes_.end(),
                               [&](const auto& process) { return process->command().id == id; });
  return it == processes_.end() ? nullptr : it->get();
}

void Supervisor::Start(const std::string& id) {
  ManagedProcess* process = Find(id);
  if (process == nullptr) throw std::runtime_error("there is no command \"" + id + "\"");
  process->Start();
  started_.erase(std::remove(started_.begin(), started_.end(), process), started_.end());
  started_.push_back(process);
}

void Supervisor::Stop(const std::string& id) {
  if (ManagedProcess* process = Find(id)) process->Stop();
}

void Supervisor::Restart(const std::string& id) {
  if (ManagedProcess* process = Find(id)) process->Stop();
  Start(id);
}

void Supervisor::Tick() {
  for (const auto& process : processes_) process->Tick();
}

void Supervisor::StopAll() {
  // Nothing is started again meanwhile.
  for (const auto& process : processes_) {
    if (process->state() == ManagedProcess::State::kWaiting) process->Stop();
  }
  for (auto process = started_.rbegin(); process != started_.rend(); ++process) {
    (*process)->Stop();
    while ((*process)->running()) {
      Tick();
      if ((*process)->running()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  started_.clear();
}

}  // namespace evit::procman
