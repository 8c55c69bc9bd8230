// log_replay: replays a recorded log over LCM. See docs/reference/channels.md for what it sends.
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "services/log_replay/log_replay.h"

namespace {

/// "A:B", "A:" or ":B", in seconds.
std::pair<double, double> ParseSeconds(const std::string& text) {
  const std::size_t colon = text.find(':');
  double begin = 0, end = 1e9;
  const auto parse = [&text](const std::string& part, double* value) {
    char* end_of_number = nullptr;
    if (!part.empty()) *value = std::strtod(part.c_str(), &end_of_number);
    if (!part.empty() && *end_of_number != '\0') {
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
  evit::CommandLine line(
      "Replays EVENTS, IMU and GROUND_TRUTH of an LCM log, in real time, at another speed, or without loss");
  evit::ServiceOptions service_options;
  evit::LogReplayOptions options;
  std::string seconds;
  line.Add("--log", &options.log, "LCM log, e.g. made by `evit import`").Required();
  line.Add("--log-prefix", &options.log_prefix, "of the channel names in the log; default: found by itself");
  line.AddFlag("--allow-truncated", &options.allow_truncated,
               "replay the complete messages of a log that was cut off");
  line.Add("--speed", &options.speed, "1: real time, 2: twice as fast, 0: unpaced (default of --lossless)")
      .Range(0.0, 1000.0);
  line.Add("--wait-for", &options.wait_for, "consumer whose CREDIT counts with --lossless; may be repeated")
      .ShowDefault();
  line.AddFlag("--start-paused", &options.start_paused, "wait for RESUME on REPLAY_CONTROL");
  const auto from = line.Add("--from", &options.from_utime, "start at this sensor time, us");
  line.Add("--seconds", &seconds, "part to replay, A:B, s after the first message").Excludes(from);
  line.Add("--position", &options.position,
           "file that keeps the position: started again, the replay continues there (real time only)");
  line.AddFlag("--exit-at-end", &options.exit_at_end, "end when all is sent (with --lossless: consumed)");
  evit::AddServiceOptions(&line, &service_options);
  if (const auto code = line.Parse(argc, argv)) return *code;
  if (!seconds.empty()) options.seconds = ParseSeconds(seconds);
  options.lossless = service_options.lossless;
  const auto bus = evit::OpenServiceBus(service_options);
  evit::LogReplay replay(options, bus.get(), evit::Channels(service_options.prefix));
  return evit::RunService(&replay, bus.get());
}

}  // namespace

int main(int argc, char** argv) { return evit::GuardedMain("log_replay", &Run, argc, argv); }
