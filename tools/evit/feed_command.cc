#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "common/bus/log_file.h"
#include "common/files/staged_file.h"
#include "common/service/runner.h"
#include "common/service/stop_signals.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/evit/pipeline_bus.h"
#include "tools/feed/fake_camera.h"
#include "tools/feed/feed_listeners.h"
#include "tools/feed/feed_loop.h"
#include "tools/formats/import/drop_counts.h"

namespace evit::commands {
namespace {

struct FeedCommand {
  int tcp = 0, udp = 0, pid = 0;
  std::string from, out, lcm_url, prefix, size;
  bool realtime = false, to_stdout = false;
  double imu_offset = 0;
  feed::FeedOptions options;
};

std::unique_ptr<feed::FeedInput> OpenInput(const FeedCommand& o) {
  if ((o.tcp > 0) + (o.udp > 0) + !o.from.empty() > 1)
    throw std::runtime_error("--tcp, --udp and --from exclude each other");
  if (o.tcp > 0) return feed::ListenTcp(o.tcp);
  if (o.udp > 0) return feed::ListenUdp(o.udp);
  if (!o.from.empty()) return feed::OpenFakeCamera(o.from, o.realtime);
  return feed::OpenStandardInput();
}

// The records themselves: a fake driver for another `evit feed`, or a file to keep.
void CopyRecords(feed::FeedInput* input, const StopSignals& stop) {
  std::vector<std::uint8_t> block(1 << 18);
  std::size_t n = 0;
  while (!stop.received()) {
    const auto state = input->Read(block.data(), block.size(), 100, &n);
    if (state == feed::FeedInput::State::kEnd) break;
    if (std::fwrite(block.data(), 1, n, stdout) != n)
      throw std::runtime_error("standard output takes no more");
  }
  if (std::fflush(stdout) != 0) throw std::runtime_error("standard output takes no more");
}

void PrintCounts(const feed::FeedCounts& c, double seconds) {
  std::fprintf(stderr,
               "%lld events in %lld packets (%.2f million/s), %lld IMU samples; dropped: %lld late, %lld "
               "outside the sensor, %lld "
               "not finite; IMU offset %.6f s\n",
               static_cast<long long>(c.events), static_cast<long long>(c.packets),
               1e-6 * static_cast<double>(c.events) / seconds, static_cast<long long>(c.imu),
               static_cast<long long>(c.late), static_cast<long long>(c.outside),
               static_cast<long long>(c.invalid), 1e-6 * static_cast<double>(c.imu_offset));
}

// Published or not, a wrong --size is told.
void RequireMostSent(const std::string& input, const feed::FeedCounts& counts, const Bus* bus) {
  if (bus != nullptr && bus->send_errors() > 0)
    throw std::runtime_error(std::to_string(bus->send_errors()) +
                             " messages could not be sent; is the LCM URL's network up?");
  formats::DropCounts dropped;
  dropped.outside = counts.outside;
  formats::RequireMostKept(input, dropped, counts.events, "events");
}

void Feed(const FeedCommand& o) {
  using Clock = std::chrono::steady_clock;
  const StopSignals stop;
  const std::unique_ptr<feed::FeedInput> input = OpenInput(o);
  if (o.to_stdout) return CopyRecords(input.get(), stop);
  std::unique_ptr<Bus> bus;
  std::optional<feed::FeedListeners> listeners;
  std::optional<StagedFile> file;
  std::unique_ptr<LogWriter> log;
  if (o.out.empty()) {
    bus = OpenBusToFeed(o.lcm_url, o.pid);  // behind the input, whose port is this host's
    listeners.emplace(ResolveLcmUrl(o.lcm_url), o.prefix);
  } else {
    RequireLogOutput("--out", o.out);
    RequireNotAnInput("--out", o.out, {o.from});
    file.emplace(o.out);
    log = std::make_unique<LogWriter>(file->part());
  }
  Utime logged =
      std::numeric_limits<Utime>::min();  // a log's stamps increase; packets come up to 5 ms after the IMU
  const auto epoch = std::chrono::duration_cast<std::chrono::microseconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                         .count();
  feed::FeedPublisher publisher(
      o.options, Channels(o.prefix), epoch,
      [&](Utime t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
        if (log) {
          log->Write(logged = std::max(logged, t), channel, bytes.data(), bytes.size());
        } else {
          bus->Publish(channel, bytes.data(), bytes.size());
        }
      });
  const Clock::time_point begin = Clock::now();
  const bool tty = isatty(STDERR_FILENO) == 1;
  Clock::time_point shown;
  std::fprintf(stderr, "evit feed: reading %s\n", input->name().c_str());
  feed::RunFeed(
      input.get(), &publisher, [&] { return stop.received(); },
      [&](const feed::FeedCounts& c) {
        if (listeners) listeners->Tick();
        const Clock::time_point now = Clock::now();
        if (!tty && now - shown < std::chrono::seconds(3)) return;
        shown = now;
        std::fprintf(stderr, tty ? "\r%lld events, %lld IMU samples" : "%lld events, %lld IMU samples\n",
                     static_cast<long long>(c.events), static_cast<long long>(c.imu));
      });
  if (publisher.counts().events + publisher.counts().outside == 0)
    throw std::runtime_error(input->name() + ": sent no events");
  if (log) log->Close();
  if (tty) std::fputc('\n', stderr);
  PrintCounts(publisher.counts(), std::chrono::duration<double>(Clock::now() - begin).count());
  if (listeners && !stop.received()) listeners->Finish();
  RequireMostSent(input->name(), publisher.counts(), bus.get());
  if (file) file->Commit();  // a log is left only where it is whole
}

}  // namespace

void AddFeedCommand(CLI::App* app) {
  auto o = std::make_shared<FeedCommand>();
  CLI::App* feed = app->add_subcommand(
      "feed", "Publish a live camera and IMU: records from any driver become EVENTS and IMU");
  feed->add_option("--tcp", o->tcp, "Port of this host that one driver connects to (default: standard input)")
      ->check(CLI::Range(1, 65535));
  feed->add_option("--udp", o->udp, "Port of this host that takes datagrams of whole records")
      ->check(CLI::Range(1, 65535));
  feed->add_option("--from", o->from, "Log of evit import to play as if it were a camera");
  feed->add_flag("--realtime", o->realtime,
                 "With --from: as fast as it was recorded (default: as fast as it is taken)");
  feed->add_flag("--to-stdout", o->to_stdout,
                 "Write the records to standard output in place of publishing them");
  feed->add_option("--out", o->out, "Write a log in place of publishing");
  feed->add_option("--size", o->size,
                   "WxH of the sensor; events outside are dropped (default: whatever comes)");
  feed->add_option("--imu-offset", o->imu_offset,
                   "Seconds to add to IMU stamps to get the clock of the events");
  feed->add_flag("--align-clocks", o->options.align_clocks,
                 "Find that offset in the first second, from when data arrive");
  feed->add_option("--lcm-url", o->lcm_url,
                   "Bus (default: LCM_DEFAULT_URL, else that of the pipeline running here)");
  feed->add_option("--pid", o->pid, "Process of the evit up to feed, where several run here");
  feed->add_option("--prefix", o->prefix, "Prefix of the channels");
  feed->footer(
      "Records are fixed and little-endian. Event, 16 bytes: u8 1, u8 polarity, u16 x, u16 y, u16 0, i64 t "
      "(us).\n"
      "IMU, 64 bytes: u8 2, 7 bytes 0, i64 t (us), 3 x f64 rad/s, 3 x f64 m/s^2. Drivers in Python and C++: "
      "docs/examples.\n"
      "Example: driver | evit feed --size 640x480        evit feed --from boxes.lcmlog --realtime");
  feed->callback([o] {
    if (!o->size.empty()) ParseSize(o->size, &o->options.width, &o->options.height);
    o->options.imu_offset = static_cast<Utime>(1e6 * o->imu_offset);
    Feed(*o);
  });
}

}  // namespace evit::commands
