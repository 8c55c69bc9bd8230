#include "tools/feed/feed_listeners.h"

#include <cstdint>
#include <cstdio>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/lcm_bus.h"
#include "evit/service_status_t.hpp"

namespace evit::feed {
namespace {

constexpr auto kFeedPatience = std::chrono::seconds(3);

}  // namespace

FeedListeners::FeedListeners(const std::string& url, const std::string& prefix) : bus_(OpenLcmBus(url)) {
  bus_->Subscribe(Channels(prefix).status,
                  [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                    service_status_t status;
                    std::string why;
                    if (!DecodeChecked(data, size, &status, &why)) return;
                    heard_ = heard_ || status.service == "frame_builder";
                  });
}

void FeedListeners::Tick() {
  if (heard_ || warned_) return;
  bus_->Poll(0);
  if (heard_ || Clock::now() - begin_ < kFeedPatience) return;
  warned_ = true;
  std::fprintf(stderr,
               "\nevit feed: warning: no frame_builder is heard on this bus, so nobody tracks what is sent. "
               "Start `evit up evit.procman robot` first, or name its bus with --lcm-url\n");
}

void FeedListeners::Finish() {
  while (!heard_ && !warned_) {
    bus_->Poll(100);
    Tick();
  }
}

}  // namespace evit::feed
