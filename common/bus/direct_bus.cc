#include <chrono>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/lcm_bus.h"
#include "common/bus/lcm_connection.h"
#include "common/bus/limits.h"
#include "common/bus/udp_receiver.h"

namespace evit {
namespace {

constexpr std::size_t kSmall = 4096;  // bytes: copying costs less than memory of its own
constexpr std::size_t kMaxSpare = 64;
constexpr char kSelfTest[] = "LCM_SELF_TEST";  // LCM's own name for it

/// Sends as LCM does, and receives by the thread that polls: no thread of LCM's between kernel and handler,
/// no copy of large messages.
class DirectBus : public Bus {
 public:
  explicit DirectBus(const std::string& url)
      : connection_(url), receiver_(connection_.url(), connection_.granted_receive_buffer()) {
    receiver_.Hear({});
  }

  void Publish(const std::string& channel, const void* data, std::size_t size) override {
    connection_.Publish(channel, data, size);
  }

  void Subscribe(const std::string& channel, Handler handler) override {
    if (subscribers_.empty()) TestReception();
    subscribers_.push_back({channel, std::move(handler), 0});
    std::vector<std::string> channels;
    for (const Subscriber& subscriber : subscribers_) channels.push_back(subscriber.channel);
    receiver_.Hear(channels);
  }

  int Poll(int timeout_ms) override {
    if (queue_.empty() && receiver_.Wait(timeout_ms)) Drain();
    // What arrives meanwhile is taken from the kernel but waits for the next Poll: a flooded bus must not
    // starve Tick().
    const std::size_t waiting = queue_.size();
    for (std::size_t i = 0; i < waiting; ++i) {
      Queued message = std::move(queue_.front());
      queue_.pop_front();
      message.subscriber->queued -= message.size;
      message.subscriber->handler(message.subscriber->channel, message.memory.data() + message.begin,
                                  message.size);
      if (message.memory.size() > kSmall && spare_.size() < kMaxSpare)
        spare_.push_back(std::move(message.memory));
      Drain();
    }
    return static_cast<int>(waiting);
  }

  int granted_receive_buffer() const override { return connection_.granted_receive_buffer(); }
  std::int64_t send_errors() const override { return connection_.send_errors(); }
  std::int64_t queue_drops() const override { return queue_drops_; }

 private:
  struct Subscriber {
    std::string channel;
    Handler handler;
    std::size_t queued;  // bytes
  };
  struct Queued {
    Subscriber* subscriber;
    std::vector<std::uint8_t> memory;
    std::size_t begin, size;  // of the data in it
  };
  static constexpr int kMaxDrain = 4096;

  void Drain() {
    MessageAssembler::Message message;
    for (int i = 0; i < kMaxDrain && receiver_.Read(&message); ++i) Enqueue(message);
  }

  void Enqueue(const MessageAssembler::Message& message) {
    Subscriber* last = nullptr;
    for (Subscriber& subscriber : subscribers_) {
      if (subscriber.channel != message.channel) continue;
      if (last != nullptr) EnqueueCopy(last, message);
      last = &subscriber;
    }
    if (last == nullptr) return;
    if (message.size <= kSmall) {
      EnqueueCopy(last, message);
    } else if (Admit(last, message.size)) {
      std::vector<std::uint8_t> memory;
      if (!spare_.empty()) {
        memory = std::move(spare_.back());
        spare_.pop_back();
      }
      std::size_t begin = 0;
      receiver_.ExchangeMemory(message, &memory, &begin);
      queue_.push_back({last, std::move(memory), begin, message.size});
    }
  }

  void EnqueueCopy(Subscriber* subscriber, const MessageAssembler::Message& message) {
    if (!Admit(subscriber, message.size)) return;
    queue_.push_back({subscriber, {message.data, message.data + message.size}, 0, message.size});
  }

  bool Admit(Subscriber* subscriber, std::size_t size) {
    if (subscriber->queued + size > kMaxQueuedBytes) {
      ++queue_drops_;
      return false;
    }
    subscriber->queued += size;
    return true;
  }

  /// A firewall drops multicast in silence: a message of our own must come back.
  void TestReception() {
    using Clock = std::chrono::steady_clock;
    receiver_.Hear({kSelfTest});
    const auto end = Clock::now() + std::chrono::seconds(10);
    while (Clock::now() < end) {
      connection_.Publish(kSelfTest, kSelfTest, sizeof kSelfTest);
      if (!receiver_.Wait(100)) continue;
      MessageAssembler::Message message;
      while (receiver_.Read(&message)) {
        if (message.channel == kSelfTest) return;
      }
    }
    throw std::runtime_error(
        "cannot receive from the LCM bus: is multicast routed, and not filtered by a firewall?");
  }

  LcmConnection connection_;
  UdpReceiver receiver_;
  std::int64_t queue_drops_ = 0;
  std::deque<Subscriber> subscribers_;  // the queue holds their addresses
  std::deque<Queued> queue_;
  std::vector<std::vector<std::uint8_t>> spare_;  // memory of messages already handled
};

}  // namespace

std::unique_ptr<Bus> OpenDirectLcmBus(const std::string& url) {
  constexpr int kEnough = 2 << 20;  // bytes: a keyframe of 720p while the one before is worked on
  const LcmUrl parsed = ParseLcmUrl(url);
  if (!parsed.multicast ||
      ProbeReceiveBuffer(parsed.receive_buffer > 0 ? parsed.receive_buffer : kDefaultReceiveBuffer) < kEnough)
    return OpenLcmBus(url);
  return std::make_unique<DirectBus>(url);
}

}  // namespace evit
