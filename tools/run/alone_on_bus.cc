#include "tools/run/alone_on_bus.h"

#include <unistd.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "common/service/status_reporter.h"
#include "procman/wire.h"

namespace evit::run {
namespace {

using Clock = std::chrono::steady_clock;

void AskWhoIsThere(Bus* bus) {
  procman_lcm::discovery_t message;
  message.utime = HostTime();
  message.host = "evit";
  message.nonce = getpid();
  const std::vector<std::uint8_t> bytes = procman::EncodeProcman(message);
  bus->Publish(procman::kPmDiscover, bytes.data(), bytes.size());
}

}  // namespace

void RequireAlone(Bus* bus, const std::string& id) {
  constexpr auto kPatience = std::chrono::milliseconds(350), kRepeat = std::chrono::milliseconds(100);
  // A bus keeps its subscriptions: what they write to must live as long.
  const auto commands = std::make_shared<std::optional<std::string>>();
  bus->Subscribe(procman::kPmInfo,
                 [commands, id](const std::string&, const std::uint8_t* data, std::size_t size) {
                   procman_lcm::deputy_info_t message;
                   if (!procman::DecodeProcman(data, size, &message) || message.deputy_id != id) return;
                   std::string running;
                   for (const auto& status : message.cmds) {
                     if (status.pid != 0)
                       running += (running.empty() ? " with " : ", ") + status.cmd.command_id;
                   }
                   *commands = running;
                 });
  const Clock::time_point end = Clock::now() + kPatience;
  Clock::time_point ask = Clock::now();
  while (Clock::now() < end && !*commands) {
    if (Clock::now() >= ask) {
      AskWhoIsThere(bus);
      ask += kRepeat;
    }
    bus->Poll(20);
  }
  if (!*commands) return;
  throw std::runtime_error("another pipeline (deputy \"" + id + "\"" + **commands +
                           ") is at work on this bus; both would hear each other: stop it, or give this one "
                           "--prefix NAME/ or another port in --lcm-url");
}

}  // namespace evit::run
