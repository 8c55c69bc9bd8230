#pragma once

#include <functional>

#include "tools/feed/feed_input.h"
#include "tools/feed/feed_publisher.h"

namespace evit::feed {

/// Reads records and publishes them until the input ends or `stop` says so; `progress` is called a few times
/// a second. What waits is sent as soon as the input pauses for 2 ms. Throws std::runtime_error naming the
/// input where it sends no records.
void RunFeed(FeedInput* input, FeedPublisher* publisher, const std::function<bool()>& stop,
             const std::function<void(const FeedCounts&)>& progress);

}  // namespace evit::feed
