// Recordings on disk: EVT 3.0 and HDF5 to a log, as evit import does it, against the same decoded word by
// word and event by event.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "bench/counters.h"
#include "tools/formats/hdf5/event_file_writer.h"
#include "tools/formats/import/stream_writer.h"
#include "tools/formats/prophesee/evt3_writer.h"
#include "tools/formats/recognition/import_recording.h"

namespace evit::bench {
namespace {

constexpr std::size_t kEvents = 4'000'000;

// A recording in all forms, made once: 0.7 million events a second.
class Files {
 public:
  Files() {
    std::filesystem::create_directories(folder_);
    EventArray events;
    std::mt19937 rng(1);
    for (Utime t = 0; events.size() < kEvents; t += static_cast<Utime>(rng() % 4))
      events.push_back(t, rng() % 1280, rng() % 720, rng() % 2);
    formats::Evt3Writer raw(In("a.raw"), 1280, 720, 0);
    raw.Append(events);
    raw.Close();
    formats::EventFileWriter h5(In("a.h5"), 0);
    h5.Append(events);
    h5.Close();
  }
  ~Files() { std::filesystem::remove_all(folder_); }
  std::string In(const std::string& name) const { return (folder_ / name).string(); }

 private:
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("bench_formats_" + std::to_string(getpid()));
};

const Files& Made() {
  static const Files files;
  return files;
}

void Import(benchmark::State& state, const char* name) {
  formats::RecordingImport job;
  job.paths = {Made().In(name)};
  job.out = Made().In("out.lcmlog");
  job.width = 1280;
  job.height = 720;
  for (auto _ : state) {
    const auto summary = formats::ImportRecording(
        job, [](const formats::RecordingInfo&, SE3*) {}, [](double) {});
    if (summary.n_events != static_cast<std::int64_t>(kEvents)) state.SkipWithError("events are missing");
  }
  PerSecond(state, kEvents, 20e6, 0);
}

void Evt3(benchmark::State& state) { Import(state, "a.raw"); }
BENCHMARK(Evt3)->Name("EVT 3.0 to log, events/ours")->Unit(benchmark::kMillisecond);

void Evt3Reference(benchmark::State& state) {
  for (auto _ : state) {
    std::ifstream file(Made().In("a.raw"), std::ios::binary);
    for (std::string line; std::getline(file, line) && line != "% end";) {
    }
    formats::StreamWriter writer(Made().In("out.lcmlog"), 0, {}, {});
    std::uint16_t word = 0, high = 0, low = 0, y = 0;
    Utime wraps = 0;
    while (file.read(reinterpret_cast<char*>(&word), 2)) {
      const std::uint16_t value = word & 0xFFF;
      switch (word >> 12) {
        case 0x8:
          if (value < high) wraps += 1 << 24;
          high = value;
          break;
        case 0x6:
          low = value;
          break;
        case 0x0:
          y = value;
          break;
        default:
          writer.AddEvent(wraps + (high << 12) + low, value & 0x7FF, y,
                          static_cast<std::uint8_t>(value >> 11));
      }
    }
    writer.Close(wraps + (high << 12) + low);
  }
  PerSecond(state, kEvents, 0, 0);
}
BENCHMARK(Evt3Reference)->Name("EVT 3.0 to log, events/reference")->Unit(benchmark::kMillisecond);

void Hdf5(benchmark::State& state) { Import(state, "a.h5"); }
BENCHMARK(Hdf5)->Name("HDF5 (Zstandard) to log, events/ours")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evit::bench
