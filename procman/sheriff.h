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
  /// Tells the deputy that has command `id`, again and again until it has obeyed. Throws std::runtime_error
  /// where no deputy answers, none or several have that command, or it does not obey within `longest`.
  void Give(Order order, const std::string& id, std::chrono::milliseconds longest);

  /// What is said from now on: deputy, command, text.
  void OnOutput(std::function<void(const procman_lcm::output_t&)> sink);

 private:
  void Discover();
  std::string DeputyOf(const std::string& id) const;
  const procman_lcm::cmd_status_t* StatusOf(const std::string& deputy, const std::string& id) const;

  Bus* bus_;
  std::map<std::string, procman_lcm::deputy_info_t> deputies_;
};

}  // namespace evit::procman
