// Recordings on disk to a log, as evit import does it; EVT 3.0 against the same decoded word by
// word and event by event.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

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
    WriteDat(events);
    WriteNumpy(events);
    WriteText(events);
  }
  ~Files() { std::filesystem::remove_all(folder_); }
  std::string In(const std::string& name) const { return (folder_ / name).string(); }

 private:
  void WriteDat(const EventArray& events) const {
    std::ofstream file(In("a.dat"), std::ios::binary);
    file << "% Version 2\n% Height 720\n% Width 1280\n" << std::string("\x0C\x08", 2);
    for (std::size_t k = 0; k < events.size(); ++k) {
      const std::uint32_t word[] = {
          static_cast<std::uint32_t>(events.t[k]),
          events.x[k] | std::uint32_t{events.y[k]} << 14 | std::uint32_t{events.p[k]} << 28};
      file.write(reinterpret_cast<const char*>(word), sizeof word);
    }
  }
  void WriteNumpy(const EventArray& events) const {
    std::string header =
        "{'descr': [('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '|u1')], 'fortran_order': False, "
        "'shape': (" +
        std::to_string(events.size()) + ",), }\n";
    std::ofstream file(In("a.npy"), std::ios::binary);
    file << std::string("\x93NUMPY\x01\0", 8) << static_cast<char>(header.size() & 0xFF)
         << static_cast<char>(header.size() >> 8) << header;
    for (std::size_t k = 0; k < events.size(); ++k) {
      file.write(reinterpret_cast<const char*>(&events.t[k]), 8);
      file.write(reinterpret_cast<const char*>(&events.x[k]), 2);
      file.write(reinterpret_cast<const char*>(&events.y[k]), 2);
      file.write(reinterpret_cast<const char*>(&events.p[k]), 1);
    }
  }
  void WriteText(const EventArray& events) const {
    std::FILE* file = std::fopen(In("a.txt").c_str(), "w");
    for (std::size_t k = 0; k < events.size(); ++k)
      std::fprintf(file, "%.6f %d %d %d\n", 1e-6 * static_cast<double>(events.t[k]), events.x[k], events.y[k],
                   events.p[k]);
    std::fclose(file);
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("bench_formats_" + std::to_string(getpid()));
};

const Files& Made() {
  static const Files files;
  return files;
}

// `target`: events a second that an issue asks for; 0: none.
void Import(benchmark::State& state, const char* name, double target = 0) {
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
  PerSecond(state, kEvents, target, 0);
}

void Evt3(benchmark::State& state) { Import(state, "a.raw", 20e6); }
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

void Hdf5(benchmark::State& state) { Import(state, "a.h5", 20e6); }
BENCHMARK(Hdf5)->Name("HDF5 (Zstandard) to log, events/ours")->Unit(benchmark::kMillisecond);

void Dat(benchmark::State& state) { Import(state, "a.dat"); }
BENCHMARK(Dat)->Name("DAT to log, events/ours")->Unit(benchmark::kMillisecond);

void Numpy(benchmark::State& state) { Import(state, "a.npy"); }
BENCHMARK(Numpy)->Name("numpy to log, events/ours")->Unit(benchmark::kMillisecond);

void Text(benchmark::State& state) { Import(state, "a.txt"); }
BENCHMARK(Text)->Name("text to log, events/ours")->Unit(benchmark::kMillisecond);

// The least that any import does: the bytes of the log are written.
void WriteBytes(benchmark::State& state) {
  constexpr std::size_t kLogBytes = 9 * kEvents, kBlock = 63 << 10;
  const std::vector<char> bytes(kLogBytes, 1);
  for (auto _ : state) {
    std::FILE* file = std::fopen(Made().In("bytes").c_str(), "wb");
    for (std::size_t at = 0; at < kLogBytes; at += kBlock)
      std::fwrite(bytes.data() + at, 1, std::min(kBlock, kLogBytes - at), file);
    std::fclose(file);
  }
  PerSecond(state, kEvents, 0, 0);
}
BENCHMARK(WriteBytes)->Name("bytes of the log, events/reference")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evit::bench
