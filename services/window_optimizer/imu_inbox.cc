#include "services/window_optimizer/imu_inbox.h"

#include "common/bus/codec.h"
#include "common/wire/imu_wire.h"

namespace evit {

std::vector<ImuSample> ImuInbox::OnMessage(const std::uint8_t* data, std::size_t size) {
  imu_batch_t message;
  if (!DecodeChecked(data, size, &message)) {
    counter_.CountInvalid();
    return {};
  }
  if (counter_.Commit(message.epoch, message.seq) == SequenceCounter::Verdict::kNewEpoch) {
    history_.Clear();
    guard_.Clear();
  }
  std::vector<ImuSample> samples;
  const auto use = [&](const ImuSample& sample) {
    if (history_.Add(sample)) samples.push_back(sample);
  };
  for (const ImuSample& sample : SamplesOf(message))
    guard_.Push(sample, use, [&](const ImuSample&) { ++*ahead_; });
  return samples;
}

}  // namespace evit
