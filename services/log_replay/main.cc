// log_replay: replays a recorded log over LCM. See docs/reference/channels.md for what it sends.
#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string>

#include "services/log_replay/log_replay.h"

namespace {

/// "A:B", "A:" or ":B", in seconds.
std::pair<double, double> ParseSeconds(const std::string& text) {
  const std::size_t colon = text.find(':');
  double begin = 0, end = 1e9;
  const auto parse = [&text](const std::string& part, double* value) {
    if (!part.empty() && !CLI::detail::lexical_cast(part, *value)) {
      throw std::runtime_error("--seconds " + text + ": not of the form A:B, e.g. 2.5:10");
    }
  };
  if (colon == std::string::npos)
    throw std::runtime_error("--seconds " + text + ": not of the form A:B, e.g. 2.5:10");
  parse(text.substr(0, colon), &begin);
  parse(text.substr(colon + 1), &end);
  if (!(begin >= 0 && begin < end && end <= 1e9)) {
    throw std::runtime_error("--seconds " + text + ": needs 0 <= A < B");
  }
  return {begin, end};
}

int Run(int argc, char** argv) {
  CLI::App app(
      "Replays EVENTS, IMU and GROUND_TRUTH of an LCM log, in real time, at another speed, or without loss");
  evit::ServiceOptions service_options;
  evit::LogReplayOptions options;
  std::string seconds;
  app.add_option("--log", options.log, "LCM log, e.g. made by `evit import`")->required();
  app.add_option("--log-prefix", options.log_prefix,
                 "of the channel names in the log; default: found by itself");
  app.add_flag("--allow-truncated", options.allow_truncated,
               "replay what is whole of a log that was cut off");
  app.add_option("--speed", options.speed,
                 "1: real time, 2: twice as fast, 0: unpaced (default of --lossless)")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--wait-for", options.wait_for,
                 "consumer whose CREDIT counts with --lossless; may be repeated")
      ->capture_default_str();
  app.add_flag("--start-paused", options.start_paused, "wait for RESUME on REPLAY_CONTROL");
  auto* from = app.add_option("--from", options.from_utime, "start at this sensor time, us");
  app.add_option("--seconds", seconds, "part to replay, A:B, s after the first message")->excludes(from);
  app.add_option("--position", options.position,
                 "file that keeps the position: started again, the replay continues there (real time only)");
  app.add_flag("--exit-at-end", options.exit_at_end, "end when all is sent (with --lossless: consumed)");
  evit::AddServiceOptions(&app, &service_options);
  CLI11_PARSE(app, argc, argv);
  if (!seconds.empty()) options.seconds = ParseSeconds(seconds);
  options.lossless = service_options.lossless;
  const auto bus = evit::OpenServiceBus(service_options);
  evit::LogReplay replay(options, bus.get(), evit::Channels(service_options.prefix));
  return evit::RunService(&replay, bus.get());
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("log_replay", &Run, argc, argv); }
