#include "common/bus/lcm_bus.h"

#include <lcm/lcm.h>

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/bus/channel_filter.h"
#include "common/bus/lcm_connection.h"
#include "common/bus/lcm_url.h"
#include "common/bus/limits.h"

namespace evit {

namespace {

/// LCM channel names are regular expressions of GLib's; a backslash before each other character takes it
/// literally.
std::string EscapeRegex(const std::string& channel) {
  std::string result;
  for (const char c : channel) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!plain) result += '\\';
    result += c;
  }
  return result;
}

class LcmBus : public Bus {
 public:
  explicit LcmBus(const std::string& url) : connection_(url) {}

  void Publish(const std::string& channel, const void* data, std::size_t size) override {
    connection_.Publish(channel, data, size);
  }

  void Subscribe(const std::string& channel, Handler handler) override {
    const std::vector<int> before =
        url().multicast && socket_ < 0 ? SocketsOnPort(url().port) : std::vector<int>();
    subscribers_.push_back({this, channel, std::move(handler), 0});
    lcm_subscription_t* subscription = lcm_subscribe(connection_.lcm(), EscapeRegex(channel).c_str(),
                                                     &LcmBus::OnMessage, &subscribers_.back());
    if (subscription == nullptr) {
      subscribers_.pop_back();
      throw std::runtime_error("cannot receive from the LCM bus (channel " + channel +
                               "): is multicast routed, and not filtered by a firewall?");
    }
    if (url().multicast && subscribers_.size() == 1) {  // LCM has its socket by now
      HearOnlyOwnGroup(url());
      socket_ = NewSocket(before);
    }
    HearOnlySubscribed();
    lcm_subscription_set_queue_capacity(subscription, 0);  // unlimited: Enqueue() bounds and counts
  }

  int Poll(int timeout_ms) override {
    connection_.RequireConnection();
    if (queue_.empty() && lcm_handle_timeout(connection_.lcm(), timeout_ms) <= 0) return 0;
    Drain();
    // What arrives meanwhile is taken from LCM but waits for the next Poll: a flooded bus must not starve
    // Tick().
    const std::size_t waiting = queue_.size();
    for (std::size_t i = 0; i < waiting; ++i) {
      Queued message = std::move(queue_.front());
      queue_.pop_front();
      message.subscriber->queued -= message.data.size();
      message.subscriber->handler(message.subscriber->channel, message.data.data(), message.data.size());
      if (spare_.size() < kMaxSpare) spare_.push_back(std::move(message.data));
      Drain();
    }
    return static_cast<int>(waiting);
  }

  int granted_receive_buffer() const override { return connection_.granted_receive_buffer(); }
  std::int64_t send_errors() const override { return connection_.send_errors(); }
  std::int64_t queue_drops() const override { return queue_drops_; }

 private:
  /// The one on the URL's port that is not in `before`; -1 where there is no such, or several.
  int NewSocket(const std::vector<int>& before) const {
    std::vector<int> others;
    for (const int fd : SocketsOnPort(url().port)) {
      if (std::find(before.begin(), before.end(), fd) == before.end()) others.push_back(fd);
    }
    return others.size() == 1 ? others.front() : -1;
  }
  void HearOnlySubscribed() const {
    if (socket_ < 0) return;
    std::vector<std::string> channels;
    for (const Subscriber& subscriber : subscribers_) channels.push_back(subscriber.channel);
    (void)HearOnlyChannels(socket_, channels);  // without it what is not subscribed is dropped later
  }

  struct Subscriber {
    LcmBus* bus;
    std::string channel;
    Handler handler;
    std::size_t queued;  // bytes
  };
  struct Queued {
    Subscriber* subscriber;
    std::vector<std::uint8_t> data;
  };
  // What waits for one subscription: some seconds of events, 16 times what lossless replay has under way.
  // LCM's own limit counts messages whatever their size and drops in silence.
  static constexpr std::size_t kMaxQueuedBytes = std::size_t{16} << 20;
  static constexpr std::size_t kMaxSpare = 64;
  static constexpr int kMaxDrain = 4096;

  static void OnMessage(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
    auto* subscriber = static_cast<Subscriber*>(user);
    subscriber->bus->Enqueue(subscriber, static_cast<const std::uint8_t*>(received->data),
                             received->data_size);
  }

  void Enqueue(Subscriber* subscriber, const std::uint8_t* data, std::size_t size) {
    if (subscriber->queued + size > kMaxQueuedBytes) {
      ++queue_drops_;
      return;
    }
    std::vector<std::uint8_t> copy;
    if (!spare_.empty()) {
      copy = std::move(spare_.back());
      spare_.pop_back();
    }
    copy.assign(data, data + size);
    subscriber->queued += size;
    queue_.push_back({subscriber, std::move(copy)});
  }

  /// Takes over what LCM's reader thread has queued, so that no queue without a bound can grow.
  void Drain() {
    for (int i = 0; i < kMaxDrain && connection_.Connected() && lcm_handle_timeout(connection_.lcm(), 0) > 0;
         ++i) {
    }
  }

  const LcmUrl& url() const { return connection_.url(); }

  LcmConnection connection_;
  int socket_ = -1;  // LCM's, which it receives by; -1: not known
  std::int64_t queue_drops_ = 0;
  std::deque<Subscriber> subscribers_;  // LCM holds their addresses
  std::deque<Queued> queue_;
  std::vector<std::vector<std::uint8_t>> spare_;  // memory of messages already handled
};

}  // namespace

std::unique_ptr<Bus> OpenLcmBus(const std::string& url) { return std::make_unique<LcmBus>(url); }

}  // namespace evit
