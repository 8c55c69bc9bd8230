#include "common/tracking/feedback.h"

namespace evit {
namespace {

TrackerFeedback::Mode ModeOf(TrackerMode mode) {
  switch (mode) {
    case TrackerMode::kBootstrapping:
      return TrackerFeedback::Mode::kBootstrapping;
    case TrackerMode::kTracking:
      return TrackerFeedback::Mode::kTracking;
    case TrackerMode::kLost:
      break;
  }
  return TrackerFeedback::Mode::kLost;
}

}  // namespace

TrackerFeedback FeedbackOf(const TrackerOutput& output) {
  TrackerFeedback feedback;
  feedback.mode = ModeOf(output.mode);
  feedback.image_speed = output.image_speed;
  feedback.useful_interval = output.useful_interval;
  return feedback;
}

}  // namespace evit
