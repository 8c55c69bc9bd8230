#include "tools/formats/import/import_doubts.h"

#include "common/text/format_text.h"

namespace evit::formats {
namespace {

// As evit doctor has it (imu-rate): below the first it is an error, below the second a warning.
constexpr double kSlowestImu = 40, kSlowImu = 80;  // Hz
constexpr std::int64_t kFewSamples = 20;
constexpr std::int64_t kFewEvents = 5000;  // a keyframe takes 500 at least, and a start some of these
constexpr double kLeastCovered = 0.5;      // of the events' time

}  // namespace

std::vector<std::string> DoubtsOf(const ImportSummary& s) {
  std::vector<std::string> doubts;
  if (s.n_events < kFewEvents) {
    doubts.push_back(FormatText(
        "only %lld events in %.1f s: a keyframe alone takes 500, and tracking needs %lld or more; is it "
        "the right file, and whole?",
        static_cast<long long>(s.n_events), s.seconds, static_cast<long long>(kFewEvents)));
  }
  if (s.n_imu == 0) return doubts;
  if (s.n_imu < kFewSamples || s.imu_rate_hz < kSlowestImu) {
    doubts.push_back(FormatText(
        "only %lld IMU samples, %.3g a second, for %.1f s of events: tracking needs %.0f a second or "
        "more, 200 is usual; is it the right file, and whole?",
        static_cast<long long>(s.n_imu), s.imu_rate_hz, s.seconds, kSlowImu));
  } else if (s.imu_covers_s < kLeastCovered * s.seconds) {
    doubts.push_back(FormatText(
        "the IMU samples cover %.1f s of the %.1f s of events: there is no tracking in the rest; is it "
        "the right file, and whole?",
        s.imu_covers_s, s.seconds));
  }
  return doubts;
}

}  // namespace evit::formats
