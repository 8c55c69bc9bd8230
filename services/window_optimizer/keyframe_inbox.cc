#include "services/window_optimizer/keyframe_inbox.h"

#include <string>

#include "common/bus/codec.h"

namespace evit {
namespace {

std::string WrongEncoding(std::int8_t expected) {
  if (expected == keyframe_t::EVENT_COUNT) {
    return "keyframes hold time surfaces, EVPT needs event counts: start frame_builder with the same "
           "--config";
  }
  return "keyframes hold event counts, not time surfaces: start frame_builder and window_optimizer with the "
         "same --config";
}

std::string WrongSize(const keyframe_t& keyframe) {
  return "keyframes are " + std::to_string(keyframe.width) + "x" + std::to_string(keyframe.height) +
         " but the rig file's camera is not: start frame_builder and window_optimizer with the same --rig";
}

}  // namespace

KeyframeInbox::KeyframeInbox(StatusReporter* status, std::int8_t encoding, const Camera& camera)
    : status_(status), encoding_(encoding), width_(camera.width), height_(camera.height) {}

std::optional<keyframe_t> KeyframeInbox::Decode(const std::uint8_t* data, std::size_t size) {
  keyframe_t keyframe;
  const bool decoded = DecodeChecked(data, size, &keyframe);
  if (decoded && keyframe.encoding == encoding_ && keyframe.width == width_ && keyframe.height == height_)
    return keyframe;
  ++status_->Counter("KEYFRAME.invalid");
  if (decoded) {
    status_->SetState("failed",
                      keyframe.encoding != encoding_ ? WrongEncoding(encoding_) : WrongSize(keyframe));
  }
  return std::nullopt;
}

}  // namespace evit
