#include "tools/feed/feed_loop.h"

#include <chrono>
#include <stdexcept>

namespace evit::feed {
namespace {

constexpr int kPauseMs = 2;
constexpr std::size_t kBlock = 1 << 18;  // bytes

Utime Now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

void RunFeed(FeedInput* input, FeedPublisher* publisher, const std::function<bool()>& stop,
             const std::function<void(const FeedCounts&)>& progress) {
  RecordParser parser;
  std::vector<std::uint8_t> block(kBlock);
  EventArray events;
  std::vector<ImuSample> imu;
  Utime shown = Now();
  while (!stop()) {
    std::size_t n = 0;
    const FeedInput::State state = input->Read(block.data(), block.size(), kPauseMs, &n);
    const Utime now = Now();
    if (state == FeedInput::State::kData) {
      events.clear();
      imu.clear();
      try {
        parser.Parse(block.data(), n, &events, &imu);
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(input->name() + ": " + error.what());
      }
      publisher->Add(events, imu, now);
    } else {
      publisher->Flush();
    }
    if (state == FeedInput::State::kEnd) break;
    if (now - shown > 200'000) {
      shown = now;
      progress(publisher->counts());
    }
  }
  publisher->Close();
  if (parser.pending() > 0)
    throw std::runtime_error(input->name() + ": ended within a record (" + std::to_string(parser.pending()) +
                             " bytes)");
}

}  // namespace evit::feed
