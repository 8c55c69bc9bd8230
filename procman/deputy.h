#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "procman/process_usage.h"
#include "procman/supervisor.h"
#include "procman/wire.h"

namespace evit::procman {

/// A supervisor on the bus, as procman's deputy is: PM_INFO at 1 Hz and on change, PM_OUTPUT for what its
/// commands say, and it obeys PM_ORDERS and PM_DISCOVER. Orders choose among the commands it was given: what
/// an order says of command lines is ignored, so that nothing from the bus is ever executed.
class Deputy {
 public:
  /// `bus` must outlive this. Starts nothing yet.
  Deputy(Bus* bus, std::string id, const std::vector<ProcmanCommand>& commands,
         const ManagedProcess::Places& places);

  /// Call often.
  void Tick();

  Supervisor& supervisor() { return supervisor_; }
  const std::string& id() const { return id_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Run {
    std::int32_t id = 0;  // runid, as a sheriff counts
    int runs = 0;         // of the process, when last looked at
    ManagedProcess::State state = ManagedProcess::State::kStopped;
    ProcessUsage usage;  // when last sent
    double cpu_share = 0;
  };

  void OnOrders(const std::uint8_t* data, std::size_t size);
  void Obey(const procman_lcm::cmd_desired_t& order);
  void OnOutput(const std::string& command, const std::string& text);
  void PublishOutput(const std::string& command, const std::string& text);
  void PublishInfo();
  procman_lcm::cmd_status_t StatusOf(const ManagedProcess& process, double seconds);

  Bus* bus_;
  std::string id_;
  std::map<std::string, Run> runs_;  // by command
  HostUsage host_;
  Clock::time_point sent_;  // PM_INFO
  Clock::time_point said_;  // begin of the second that said_bytes_ counts
  std::size_t said_bytes_ = 0, left_out_ = 0;
  Supervisor supervisor_;
};

}  // namespace evit::procman
