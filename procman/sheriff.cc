#include "procman/sheriff.h"

#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace evit::procman {
namespace {

constexpr auto kRepeat = std::chrono::milliseconds(200);  // UDP may lose an order
constexpr auto kLongest = std::chrono::seconds(15);       // stop_time_allowed may pass before it is obeyed

std::int64_t HostMicroseconds() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

}  // namespace

Sheriff::Sheriff(Bus* bus) : bus_(bus) {
  bus_->Subscribe(kPmInfo, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
    procman_lcm::deputy_info_t message;
    if (!DecodeProcman(data, size, &message)) return;
    heard_[message.deputy_id] = Clock::now();
    deputies_[message.deputy_id] = std::move(message);
  });
}

void Sheriff::OnOutput(std::function<void(const procman_lcm::output_t&)> sink) {
  bus_->Subscribe(kPmOutput,
                  [sink = std::move(sink)](const std::string&, const std::uint8_t* data, std::size_t size) {
                    procman_lcm::output_t message;
                    if (DecodeProcman(data, size, &message)) sink(message);
                  });
}

void Sheriff::Discover() {
  procman_lcm::discovery_t message;
  message.utime = HostMicroseconds();
  message.host = "evit";
  message.nonce = getpid();
  const std::vector<std::uint8_t> bytes = EncodeProcman(message);
  bus_->Publish(kPmDiscover, bytes.data(), bytes.size());
}

const std::map<std::string, procman_lcm::deputy_info_t>& Sheriff::Look(std::chrono::milliseconds longest) {
  const auto end = Clock::now() + longest;
  constexpr auto kOthers = std::chrono::milliseconds(300);  // for other deputies, once one has answered
  auto asked = Clock::time_point();
  auto first = Clock::time_point::max();
  while (Clock::now() < end) {
    if (Clock::now() - asked > kRepeat) {
      Discover();
      asked = Clock::now();
    }
    bus_->Poll(20);
    if (!deputies_.empty() && first == Clock::time_point::max()) first = Clock::now();
    if (first != Clock::time_point::max() && Clock::now() - first > kOthers) break;
  }
  return deputies_;
}

const procman_lcm::cmd_status_t* Sheriff::StatusOf(const std::string& deputy, const std::string& id) const {
  for (const auto& status : deputies_.at(deputy).cmds) {
    if (status.cmd.command_id == id) return &status;
  }
  return nullptr;
}

std::string Sheriff::DeputyOf(const std::string& id) const {
  std::string found, known;
  for (const auto& [deputy, info] : deputies_) {
    for (const auto& status : info.cmds) known += (known.empty() ? "" : ", ") + status.cmd.command_id;
    if (StatusOf(deputy, id) == nullptr) continue;
    if (!found.empty())
      throw std::runtime_error("deputies " + found + " and " + deputy + " both have a command \"" + id +
                               "\"");
    found = deputy;
  }
  if (deputies_.empty()) {
    throw std::runtime_error("no deputy answered; is `evit run` or `evit up` running on the same LCM URL?");
  }
  if (found.empty()) throw std::runtime_error("there is no command \"" + id + "\"; there are: " + known);
  return found;
}

void Sheriff::Forget(std::chrono::milliseconds silent) {
  for (auto heard = heard_.begin(); heard != heard_.end();) {
    if (Clock::now() - heard->second <= silent) {
      ++heard;
      continue;
    }
    deputies_.erase(heard->first);
    heard = heard_.erase(heard);
  }
}

void Sheriff::Begin(Order order, const std::string& id) {
  Pending pending;
  pending.order = order;
  pending.deputy = DeputyOf(id);
  pending.before = *StatusOf(pending.deputy, id);
  pending.begun = Clock::now();
  if (order == Order::kStart && pending.before.pid != 0) return;
  pending_[id] = std::move(pending);
  Tick();
}

bool Sheriff::Obeyed(const Pending& pending) const {
  const auto deputy = deputies_.find(pending.deputy);
  if (deputy == deputies_.end()) return false;
  const procman_lcm::cmd_status_t* now = StatusOf(pending.deputy, pending.before.cmd.command_id);
  if (now == nullptr) return false;
  return pending.order == Order::kStop ? now->pid == 0 : now->pid != 0 && now->pid != pending.before.pid;
}

void Sheriff::Send(const Pending& pending) {
  procman_lcm::orders_t orders;
  orders.utime = HostMicroseconds();
  orders.deputy_id = pending.deputy;
  orders.sheriff_id = "evit";
  orders.ncmds = 1;
  orders.cmds.resize(1);
  orders.cmds[0].cmd = pending.before.cmd;
  orders.cmds[0].desired_runid = pending.before.actual_runid + (pending.order == Order::kStop ? 0 : 1);
  orders.cmds[0].force_quit = pending.order == Order::kStop ? 1 : 0;
  const std::vector<std::uint8_t> bytes = EncodeProcman(orders);
  bus_->Publish(kPmOrders, bytes.data(), bytes.size());
}

void Sheriff::Tick() {
  for (auto pending = pending_.begin(); pending != pending_.end();) {
    if (Obeyed(pending->second) || Clock::now() - pending->second.begun > kLongest) {
      pending = pending_.erase(pending);
      continue;
    }
    if (Clock::now() - pending->second.sent > kRepeat) {
      Send(pending->second);
      pending->second.sent = Clock::now();
    }
    ++pending;
  }
}

void Sheriff::Give(Order order, const std::string& id, std::chrono::milliseconds longest) {
  Look(longest);
  Begin(order, id);
  const auto end = Clock::now() + longest;
  while (pending(id)) {
    const Pending waiting = pending_.at(id);
    Tick();
    if (!pending(id) && Obeyed(waiting)) return;
    if (!pending(id) || Clock::now() > end) {
      pending_.erase(id);
      throw std::runtime_error(waiting.deputy + " does not obey; `evit logs " + id + "` may say why");
    }
    bus_->Poll(20);
  }
}

}  // namespace evit::procman
