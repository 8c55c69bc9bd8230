#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/bus/bus.h"
#include "procman/wire.h"

namespace evit::procman {

/// The other side of PM_*: sees all deputies and gives orders to them. Keeps nothing that a deputy does not
/// say.
class Sheriff {
 public:
  /// `bus` must outlive this.
  explicit Sheriff(Bus* bus);

  /// Asks who is there and listens until all that answer have done so, at most `longest`. By deputy id.
  const std::map<std::string, procman_lcm::deputy_info_t>& Look(std::chrono::milliseconds longest);

  enum class Order { kStart, kStop, kRestart };
  /// Begins to tell the deputy that has command `id`; Tick() says it again and again until it has obeyed.
  /// Throws std::runtime_error where no deputy has been heard, or none or several have that command.
  void Begin(Order order, const std::string& id);
  /// Call often, after Bus::Poll.
  void Tick();
  /// Whether an order for this command is being given; it is given up after 15 s.
  bool pending(const std::string& id) const { return pending_.count(id) > 0; }

  /// All of that: asks who is there, and waits until the deputy has obeyed. Throws as Begin() does, and where
  /// it does not obey within `longest`.
  void Give(Order order, const std::string& id, std::chrono::milliseconds longest);

  /// What is said from now on: deputy, command, text.
  void OnOutput(std::function<void(const procman_lcm::output_t&)> sink);

  /// All deputies heard, by id.
  const std::map<std::string, procman_lcm::deputy_info_t>& deputies() const { return deputies_; }
  /// Forgets the deputies that have not been heard for so long: they send once a second.
  void Forget(std::chrono::milliseconds silent);
  void Discover();

 private:
  using Clock = std::chrono::steady_clock;
  struct Pending {
    Order order = Order::kStart;
    std::string deputy;
    procman_lcm::cmd_status_t before;
    Clock::time_point begun, sent;
  };
  bool Obeyed(const Pending& pending) const;
  void Send(const Pending& pending);
  std::string DeputyOf(const std::string& id) const;
  const procman_lcm::cmd_status_t* StatusOf(const std::string& deputy, const std::string& id) const;

  Bus* bus_;
  std::map<std::string, procman_lcm::deputy_info_t> deputies_;
  std::map<std::string, Clock::time_point> heard_;  // by deputy
  std::map<std::string, Pending> pending_;          // by command
};

}  // namespace evit::procman
