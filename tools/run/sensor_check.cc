#include "tools/run/sensor_check.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "common/text/format_text.h"

namespace evit::run {
namespace {

constexpr std::int64_t kMostOutside = 20;  // one in so many, as in imports

}  // namespace

void CheckSensor(const RunJob& job, const LogSpan& span, const Camera& camera) {
  const EventArray& events = span.events;
  std::int64_t outside = 0;
  int x = 0, y = 0;
  for (std::size_t k = 0; k < events.size(); ++k) {
    x = std::max<int>(x, events.x[k]);
    y = std::max<int>(y, events.y[k]);
    if (events.x[k] >= camera.width || events.y[k] >= camera.height) ++outside;
  }
  const auto n = static_cast<std::int64_t>(events.size());
  if (kMostOutside * outside <= n) return;
  throw std::runtime_error(FormatText(
      "%s: %.0f %% of the events lie outside the image of %s (width: %d, height: %d); their largest x is %d, "
      "their largest y %d: give the rig file of the camera and resolution that were recorded",
      job.log.c_str(), 100.0 * static_cast<double>(outside) / static_cast<double>(n), job.rig.c_str(),
      camera.width, camera.height, x, y));
}

}  // namespace evit::run
