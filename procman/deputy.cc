#include "procman/deputy.h"

#include <algorithm>
#include <utility>

namespace evit::procman {
namespace {

constexpr std::size_t kMaxText = 16384;       // bytes of one PM_OUTPUT
constexpr std::size_t kMaxPerSecond = 65536;  // bytes: more is in the log files only

std::int64_t HostMicroseconds() {
  using std::chrono::microseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<microseconds>(now).count();
}

// Texts on the bus end with their only NUL.
std::string WithoutNul(std::string text) {
  std::replace(text.begin(), text.end(), '\0', '?');
  return text;
}

}  // namespace

Deputy::Deputy(Bus* bus, std::string id, const std::vector<ProcmanCommand>& commands,
               const ManagedProcess::Places& places)
    : bus_(bus),
      id_(std::move(id)),
      supervisor_(commands, places,
                  [this](const std::string& command, const std::string& text) { OnOutput(command, text); }) {
  for (const ProcmanCommand& command : commands) runs_[command.id];
  bus_->Subscribe(kPmOrders, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
    OnOrders(data, size);
  });
  bus_->Subscribe(kPmDiscover, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
    procman_lcm::discovery_t message;
    if (DecodeProcman(data, size, &message)) PublishInfo();
  });
}

void Deputy::OnOrders(const std::uint8_t* data, std::size_t size) {
  procman_lcm::orders_t orders;
  std::string why;
  if (!DecodeProcman(data, size, &orders, &why)) {
    PublishOutput("", "a message on PM_ORDERS was dropped: " + why + "\n");
    return;
  }
  if (orders.deputy_id != id_) return;
  for (const auto& order : orders.cmds) Obey(order);
  PublishInfo();
}

void Deputy::Obey(const procman_lcm::cmd_desired_t& order) {
  ManagedProcess* process = supervisor_.Find(order.cmd.command_id);
  if (process == nullptr) {
    PublishOutput("",
                  "\"" + order.cmd.command_id + "\" is not a command of this deputy: the order is refused\n");
    return;
  }
  Run& run = runs_[order.cmd.command_id];
  try {
    if (order.force_quit != 0) {
      process->Stop();
    } else if (order.desired_runid != run.id) {
      run.id = order.desired_runid;
      supervisor_.Restart(order.cmd.command_id);
      run.runs = process->runs();
    }
  } catch (const std::exception& error) {
    PublishOutput(order.cmd.command_id, std::string("cannot be started: ") + error.what() + "\n");
  }
}

void Deputy::OnOutput(const std::string& command, const std::string& text) {
  const Clock::time_point now = Clock::now();
  if (now - said_ >= std::chrono::seconds(1)) {
    if (left_out_ > 0) {
      PublishOutput("",
                    std::to_string(left_out_) + " bytes of output were left out; the log files have them\n");
    }
    said_ = now;
    said_bytes_ = left_out_ = 0;
  }
  if (said_bytes_ + text.size() > kMaxPerSecond) {
    left_out_ += text.size();
    return;
  }
  said_bytes_ += text.size();
  for (std::size_t at = 0; at < text.size(); at += kMaxText)
    PublishOutput(command, text.substr(at, kMaxText));
}

void Deputy::PublishOutput(const std::string& command, const std::string& text) {
  procman_lcm::output_t message;
  message.utime = HostMicroseconds();
  message.deputy_name = id_;
  message.command_id = command;
  message.text = WithoutNul(text);
  const std::vector<std::uint8_t> bytes = EncodeProcman(message);
  bus_->Publish(kPmOutput, bytes.data(), bytes.size());
}

procman_lcm::cmd_status_t Deputy::StatusOf(const ManagedProcess& process, double seconds) {
  Run& run = runs_[process.command().id];
  const ProcessUsage usage = process.running() ? ReadProcessUsage(process.pid()) : ProcessUsage();
  if (seconds >= 0.5) {
    run.cpu_share = std::max(0.0, usage.cpu_seconds - run.usage.cpu_seconds) / seconds;
    run.usage = usage;
  }
  const ProcmanCommand& command = process.command();
  procman_lcm::cmd_status_t status;
  status.cmd.command_id = command.id;
  status.cmd.exec_str = command.exec;
  status.cmd.group = command.group;
  status.cmd.auto_respawn = command.auto_respawn ? 1 : 0;
  status.cmd.stop_signal = static_cast<std::int8_t>(command.stop_signal);
  status.cmd.stop_time_allowed = static_cast<float>(command.stop_time_allowed);
  status.pid = process.pid();
  status.actual_runid = run.id;
  status.exit_code = process.running() ? 0 : process.exit_code();
  status.cpu_usage = process.running() ? static_cast<float>(run.cpu_share) : 0;
  status.mem_vsize_bytes = usage.vsize_bytes;
  status.mem_rss_bytes = usage.rss_bytes;
  return status;
}

void Deputy::PublishInfo() {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - sent_).count();
  const HostUsage host = ReadHostUsage();
  procman_lcm::deputy_info_t message;
  message.utime = HostMicroseconds();
  message.deputy_id = id_;
  const double total = host.total_seconds - host_.total_seconds;
  message.cpu_load = static_cast<float>(total > 0 ? (host.busy_seconds - host_.busy_seconds) / total : 0);
  message.phys_mem_total_bytes = host.memory_total_bytes;
  message.phys_mem_free_bytes = host.memory_free_bytes;
  message.swap_total_bytes = host.swap_total_bytes;
  message.swap_free_bytes = host.swap_free_bytes;
  for (const auto& process : supervisor_.processes()) message.cmds.push_back(StatusOf(*process, seconds));
  message.ncmds = static_cast<std::int32_t>(message.cmds.size());
  if (seconds >= 0.5) {
    host_ = host;
    sent_ = now;
  }
  const std::vector<std::uint8_t> bytes = EncodeProcman(message);
  bus_->Publish(kPmInfo, bytes.data(), bytes.size());
}

void Deputy::Tick() {
  supervisor_.Tick();
  bool changed = false;
  for (const auto& process : supervisor_.processes()) {
    Run& run = runs_[process->command().id];
    if (run.runs != process->runs()) {
      run.usage = {};
      if (run.id == 0) run.id = 1;
    }
    changed = changed || run.runs != process->runs() || run.state != process->state();
    run.runs = process->runs();
    run.state = process->state();
  }
  if (changed || Clock::now() - sent_ >= std::chrono::seconds(1)) PublishInfo();
}

}  // namespace evit::procman
