// What this machine's memory does, in the same run as the rest: the bound of whatever only moves bytes.
#include <benchmark/benchmark.h>

#include <cstring>
#include <vector>

namespace {

// One thread, read and written bytes counted alike.
void Copy(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  std::vector<char> from(n, 1), to(n, 2);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), n);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  state.counters["bytes/s"] =
      benchmark::Counter(2 * static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(Copy)->Name("Memory/cache 256 KiB")->Arg(128 << 10);
BENCHMARK(Copy)->Name("Memory/main 256 MiB")->Arg(128 << 20);

}  // namespace
