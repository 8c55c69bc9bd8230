#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "common/bus/channels.h"
#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"

namespace evit::test {

/// The other side of an optimiser's bus, in memory, where every message is delivered: sends, and keeps what
/// the service says.
class OptimizerPeer : public ::testing::Test {
 protected:
  void Listen() {
    Keep(bus_.get(), channels_.window_state, &windows_);
    Keep(bus_.get(), channels_.tracker_mode, &modes_);
    Keep(bus_.get(), channels_.body_pose, &poses_);
    Keep(bus_.get(), channels_.status, &statuses_);
  }

  template <typename Message>
  void Send(const std::string& channel, const Message& message) {
    test::Publish(bus_.get(), channel, message);
  }

  /// Of the newest STATUS; 0 where it has none of that name.
  std::int64_t LastCounter(const std::string& name) const {
    const service_status_t& status = statuses_.back();
    for (int k = 0; k < status.n_counters; ++k) {
      if (status.counter_name[k] == name) return status.counter_value[k];
    }
    return 0;
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> service_bus_ = OpenMemoryBus(hub_), bus_ = OpenMemoryBus(hub_);
  Channels channels_;
  std::vector<window_state_t> windows_;
  std::vector<tracker_mode_t> modes_;
  std::vector<body_pose_t> poses_;
  std::vector<service_status_t> statuses_;
};

}  // namespace evit::test
