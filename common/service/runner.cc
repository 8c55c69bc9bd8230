#include "common/service/runner.h"

#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <utility>

#include "common/bus/faulty_bus.h"
#include "common/bus/lcm_bus.h"
#include "common/service/status_reporter.h"
#include "common/service/stop_signals.h"

namespace evit {

namespace {

// What a service frees it needs again for the next message or keyframe: megabytes that glibc would give back
// to the kernel, which would clear them each time.
void KeepFreedMemory() {
  constexpr int kBytes = 32 << 20;
  (void)::mallopt(M_MMAP_THRESHOLD, kBytes);
  (void)::mallopt(M_TRIM_THRESHOLD, kBytes);
}

constexpr char kDefaultUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

}  // namespace

void AddServiceOptions(CommandLine* line, ServiceOptions* options, bool with_flow) {
  line->Add("--lcm-url", &options->lcm_url,
            std::string("LCM bus; default: LCM_DEFAULT_URL, else ") + kDefaultUrl);
  line->Add("--prefix", &options->prefix,
            "in front of every channel name, so that pipelines can share a bus");
  if (with_flow) {
    line->AddFlag(
        "--lossless", &options->lossless,
        "nothing is dropped: the sender waits for its receivers (default: real time, losses are counted)");
  }
}

std::string ResolveLcmUrl(const std::string& option) {
  if (!option.empty()) return option;
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  if (environment != nullptr && *environment != '\0') return environment;
  return kDefaultUrl;
}

std::unique_ptr<Bus> OpenServiceBus(const ServiceOptions& options) {
  StatusReporter::EchoToStderr();
  auto bus = OpenLcmBus(ResolveLcmUrl(options.lcm_url));
  const char* const faults = std::getenv("EVIT_BUS_FAULTS");
  if (faults == nullptr || *faults == '\0') return bus;
  return MakeFaultyBus(std::move(bus), ParseBusFaults(faults));
}

int RunService(Service* service, Bus* bus) {
  KeepFreedMemory();
  const StopSignals signals;
  while (!signals.received() && !service->done()) {
    bus->Poll(service->poll_timeout_ms());
    service->Tick();
  }
  service->Stop();
  return 0;
}

int GuardedMain(const char* program, int (*body)(int, char**), int argc, char** argv) {
  try {
    return body(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: error: %s\n", program, error.what());
  } catch (...) {
    std::fprintf(stderr, "%s: error: unknown\n", program);
  }
  return 1;
}

}  // namespace evit
