#pragma once

#include <memory>
#include <string>

#include "common/bus/bus.h"
#include "common/service/command_line.h"

namespace evit {

/// A service: a class on the bus interface. Its constructor subscribes; handlers run inside Bus::Poll.
class Service {
 public:
  virtual ~Service() = default;
  /// Called after every Poll and at least every 10 ms: time-outs, resending, STATUS.
  virtual void Tick() = 0;
  /// The service has nothing more to do (log_replay at the end of its log). Default: runs until it is
  /// stopped.
  virtual bool done() const { return false; }
  /// Last words: STATUS "finished". Called once, after SIGINT, SIGTERM or done().
  virtual void Stop() {}
  /// Longest wait for messages before the next Tick, ms (log_replay paces itself with less).
  virtual int poll_timeout_ms() const { return 10; }
};

/// Options that every service shares.
struct ServiceOptions {
  std::string lcm_url;  // empty: LCM_DEFAULT_URL, else the host's own multicast (TTL 0, 4 MiB receive buffer)
  std::string prefix;   // of all channels
  bool lossless = false;
};
void AddServiceOptions(CommandLine* line, ServiceOptions* options, bool with_flow = true);

/// The URL to open: as said above.
std::string ResolveLcmUrl(const std::string& option);

/// The live bus of a service. With EVIT_BUS_FAULTS in the environment (a test switch, see faulty_bus.h)
/// messages arrive lossy, twice, out of order or late.
std::unique_ptr<Bus> OpenServiceBus(const ServiceOptions& options);

/// Polls the bus until SIGINT, SIGTERM or done(); then Stop(). Returns the exit code 0.
int RunService(Service* service, Bus* bus);

/// Runs `body` and turns an exception into one clear line on stderr and exit code 1. For main().
int GuardedMain(const char* program, int (*body)(int, char**), int argc, char** argv);

}  // namespace evit
