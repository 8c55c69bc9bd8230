#include "tools/run/run_verdict.h"

#include <set>

#include "common/text/format_text.h"
#include "common/text/words.h"

namespace evit::run {
namespace {

constexpr double kMinTracked = 0.5;    // share of the time, below which a run has failed
constexpr double kMaxUntimely = 0.05;  // share of events or samples that may be left out for their stamps

// Channels on which services heard a second sender, e.g. "EVENTS"; a single message may have been under way
// from before.
std::string ForeignChannels(const report::Report& report) {
  constexpr double kSure = 3;
  constexpr char kCounter[] = ".two_senders";
  std::set<std::string> channels;
  for (const report::Service& service : report.services()) {
    for (const auto& [name, value] : service.counters()) {
      if (value >= kSure && EndsWith(name, kCounter))
        channels.insert(name.substr(0, name.size() - sizeof kCounter + 1));
    }
  }
  std::string list;
  for (const std::string& channel : channels) list += (list.empty() ? "" : ", ") + channel;
  return list;
}

}  // namespace

Untimely UntimelyOf(const report::Report& report) {
  const auto count = [&](const char* name) {
    for (const report::Service& service : report.services()) {
      const auto found = service.counters().find(name);
      if (service.name() == "frame_builder" && found != service.counters().end()) return found->second;
    }
    return 0.0;
  };
  Untimely out;
  out.events = count("events.late") + count("events.ahead");
  out.imu = count("imu.late") + count("imu.ahead");
  if (report.events() > 0) out.events_share = out.events / report.events();
  if (count("imu.samples") > 0) out.imu_share = out.imu / count("imu.samples");
  return out;
}

std::string FailureOf(const report::Report& report, const std::string& reason, const Untimely& untimely) {
  // The cause before what may have come of it.
  if (const std::string channels = ForeignChannels(report); !channels.empty()) {
    return "two senders on " + channels +
           ": another driver or pipeline was on this bus, and what it sent is mixed into the result; stop "
           "it, or give this run --prefix NAME/ or another port in --lcm-url";
  }
  if (report.keyframes() == 0) return "no keyframe was tracked; " + reason;
  if (report.final_mode() != "TRACKING")
    return report.final_mode() + " at the end: " + reason +
           (report.poses() == 0 ? "; the start was never found: is it another place than the map's, are the "
                                  "extrinsics inverted, or is the IMU of another clip? "
                                  "docs/troubleshooting.md, \"It does not find its start pose\""
                                : "");
  if (report.coverage() < kMinTracked)
    return FormatText(
        "poses cover only %.0f %% of the time that was played; mode_changes in report.json say why",
        100 * report.coverage());
  if (untimely.events_share > kMaxUntimely || untimely.imu_share > kMaxUntimely) {
    return FormatText(
        "%.0f %% of the events and %.0f %% of the IMU samples came too late or lie far ahead: their "
        "stamps are out of order; import the recording again, which sorts or names them",
        100 * untimely.events_share, 100 * untimely.imu_share);
  }
  return "";
}

}  // namespace evit::run
