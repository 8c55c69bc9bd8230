#include "common/bus/memory_bus.h"

#include <algorithm>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace evit {

namespace {

class MemoryBus;

}  // namespace

class MemoryHub {
 public:
  std::vector<MemoryBus*> buses;
};

namespace {

class MemoryBus : public Bus {
 public:
  explicit MemoryBus(std::shared_ptr<MemoryHub> hub) : hub_(std::move(hub)) { hub_->buses.push_back(this); }
  ~MemoryBus() override {
    auto& buses = hub_->buses;
    buses.erase(std::remove(buses.begin(), buses.end(), this), buses.end());
  }
  MemoryBus(const MemoryBus&) = delete;
  MemoryBus& operator=(const MemoryBus&) = delete;

  void Publish(const std::string& channel, const void* data, std::size_t size) override {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    std::shared_ptr<const std::vector<std::uint8_t>> copy;
    for (MemoryBus* bus : hub_->buses) {
      if (!bus->Listens(channel)) continue;
      if (!copy) copy = std::make_shared<const std::vector<std::uint8_t>>(bytes, bytes + size);
      bus->queue_.push_back({channel, copy});
    }
  }

  void Subscribe(const std::string& channel, Handler handler) override {
    handlers_.push_back({channel, std::move(handler)});
  }

  int Poll(int /*timeout_ms*/) override {
    // What handlers publish to this very bus waits for the next Poll: no recursion, no endless loop.
    const std::size_t waiting = queue_.size();
    for (std::size_t i = 0; i < waiting; ++i) {
      const Message message = std::move(queue_.front());
      queue_.pop_front();
      for (std::size_t h = 0; h < handlers_.size(); ++h) {
        if (handlers_[h].channel != message.channel) continue;
        handlers_[h].handler(message.channel, message.data->data(), message.data->size());
      }
    }
    return static_cast<int>(waiting);
  }

 private:
  struct Message {
    std::string channel;
    std::shared_ptr<const std::vector<std::uint8_t>> data;
  };
  struct Subscription {
    std::string channel;
    Handler handler;
  };

  bool Listens(const std::string& channel) const {
    return std::any_of(handlers_.begin(), handlers_.end(),
                       [&channel](const Subscription& s) { return s.channel == channel; });
  }

  std::shared_ptr<MemoryHub> hub_;
  std::deque<Subscription> handlers_;  // references stay valid when a handler subscribes
  std::deque<Message> queue_;
};

}  // namespace

std::shared_ptr<MemoryHub> MakeMemoryHub() { return std::make_shared<MemoryHub>(); }

std::unique_ptr<Bus> OpenMemoryBus(std::shared_ptr<MemoryHub> hub) {
  return std::make_unique<MemoryBus>(std::move(hub));
}

}  // namespace evit
