#include "common/bus/faulty_bus.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

namespace evit {
namespace {

using Clock = std::chrono::steady_clock;

class FaultyBus : public Bus {
 public:
  FaultyBus(std::unique_ptr<Bus> bus, BusFaults faults)
      : bus_(std::move(bus)), faults_(std::move(faults)), random_(faults_.seed) {}

  void Publish(const std::string& channel, const void* data, std::size_t size) override {
    bus_->Publish(channel, data, size);
  }

  void Subscribe(const std::string& channel, Handler handler) override {
    const BusFaults::Rule* rule = RuleOf(channel);
    if (rule == nullptr) {
      bus_->Subscribe(channel, std::move(handler));
      return;
    }
    streams_.push_back({*rule, std::move(handler), {}});
    Stream* const stream = &streams_.back();
    bus_->Subscribe(channel,
                    [this, stream](const std::string& name, const std::uint8_t* data, std::size_t size) {
                      Arrive(stream, {name, std::vector<std::uint8_t>(data, data + size)});
                    });
  }

  int Poll(int timeout_ms) override {
    int handled = Deliver();
    // What is delayed here is due whether anything new comes or not.
    handled += bus_->Poll(late_.empty() ? timeout_ms : std::min(timeout_ms, 1));
    return handled + Deliver();
  }

  int granted_receive_buffer() const override { return bus_->granted_receive_buffer(); }
  std::int64_t send_errors() const override { return bus_->send_errors(); }
  std::int64_t queue_drops() const override { return bus_->queue_drops(); }

 private:
  struct Message {
    std::string channel;
    std::vector<std::uint8_t> data;
  };
  struct Stream {
    BusFaults::Rule rule;
    Handler handler;
    std::vector<Message> held;  // overtaken by the next
  };
  struct Late {
    Clock::time_point due;
    Stream* stream;
    Message message;
  };

  const BusFaults::Rule* RuleOf(const std::string& channel) const {
    const BusFaults::Rule* any = nullptr;
    for (const BusFaults::Rule& rule : faults_.rules) {
      if (rule.channel == channel) return &rule;
      if (rule.channel == "*") any = &rule;
    }
    return any;
  }

  bool Happens(double share) { return std::generate_canonical<double, 53>(random_) < share; }

  void Arrive(Stream* stream, Message message) {
    const bool lost = Happens(stream->rule.loss), twice = Happens(stream->rule.duplicate);
    const bool overtaken = Happens(stream->rule.reorder);
    if (lost) return;
    if (overtaken && stream->held.empty()) {
      stream->held.push_back(std::move(message));
      return;
    }
    Pass(stream, message);
    if (twice) Pass(stream, message);
    for (const Message& held : std::exchange(stream->held, {})) Pass(stream, held);
  }

  void Pass(Stream* stream, const Message& message) {
    if (stream->rule.delay_ms <= 0) {
      stream->handler(message.channel, message.data.data(), message.data.size());
      return;
    }
    late_.push_back({Clock::now() + std::chrono::milliseconds(stream->rule.delay_ms), stream, message});
  }

  int Deliver() {
    int delivered = 0;
    std::deque<Late> waiting = std::exchange(late_, {});
    for (Late& late : waiting) {
      if (late.due > Clock::now()) {
        late_.push_back(std::move(late));
        continue;
      }
      late.stream->handler(late.message.channel, late.message.data.data(), late.message.data.size());
      ++delivered;
    }
    return delivered;
  }

  std::unique_ptr<Bus> bus_;
  BusFaults faults_;
  std::mt19937_64 random_;
  std::deque<Stream> streams_;  // handlers hold their addresses
  std::deque<Late> late_;
};

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    if (end > begin) parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

double Number(const std::string& part, const std::string& digits, double most) {
  char* end = nullptr;
  const double value = std::strtod(digits.c_str(), &end);
  if (digits.empty() || *end != '\0' || !(value >= 0 && value <= most)) {
    throw std::invalid_argument("bus faults: \"" + part + "\": a number from 0 to " + std::to_string(most) +
                                " is expected");
  }
  return value;
}

}  // namespace

BusFaults ParseBusFaults(const std::string& text) {
  BusFaults faults;
  for (const std::string& part : Split(text, ';')) {
    if (part.rfind("seed=", 0) == 0) {
      faults.seed = static_cast<std::uint64_t>(Number(part, part.substr(5), 1e15));
      continue;
    }
    const auto colon = part.find(':');
    if (colon == std::string::npos || colon == 0) {
      throw std::invalid_argument(
          "bus faults: \"" + part +
          "\": CHANNEL:loss=SHARE,duplicate=SHARE,reorder=SHARE,delay=MS is expected");
    }
    BusFaults::Rule rule;
    rule.channel = part.substr(0, colon);
    for (const std::string& fault : Split(part.substr(colon + 1), ',')) {
      const auto equals = std::min(fault.find('='), fault.size());
      const std::string name = fault.substr(0, equals);
      const std::string value = equals < fault.size() ? fault.substr(equals + 1) : "";
      if (name == "loss") {
        rule.loss = Number(fault, value, 1);
      } else if (name == "duplicate") {
        rule.duplicate = Number(fault, value, 1);
      } else if (name == "reorder") {
        rule.reorder = Number(fault, value, 1);
      } else if (name == "delay") {
        rule.delay_ms = static_cast<int>(Number(fault, value, 60'000));
      } else {
        throw std::invalid_argument("bus faults: \"" + fault +
                                    "\": loss, duplicate, reorder or delay is expected");
      }
    }
    faults.rules.push_back(rule);
  }
  return faults;
}

std::unique_ptr<Bus> MakeFaultyBus(std::unique_ptr<Bus> bus, const BusFaults& faults) {
  return std::make_unique<FaultyBus>(std::move(bus), faults);
}

}  // namespace evit
