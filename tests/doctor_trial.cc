// Faults with amounts, places and times drawn by chance, put into good recordings: which does the doctor name
// first or second? scripts/doctor --faults makes the recordings and starts this.
// Usage: doctor_trial SEED TIMES RECORDINGS [KIND]
// RECORDINGS: lines "name log rig map truth". Each kind of fault is put in TIMES times, each time into a
// recording drawn by chance; KIND: only those whose name has it. A Markdown table on standard output, what
// the doctor says of each fault on standard error. Exit code 1 where fewer than 95 % are named, 2 where there
// was nothing to try.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "tests/helpers/doctor_faults.h"
#include "tests/helpers/random_faults.h"

namespace evit::doctor {
namespace {

struct Recording {
  std::string name, log, rig, map, truth;
};

std::vector<Recording> ReadRecordings(const std::string& path) {
  std::ifstream file(path);
  std::vector<Recording> all;
  std::string line;
  while (std::getline(file, line)) {
    Recording r;
    std::istringstream words(line);
    if (words >> r.name >> r.log >> r.rig >> r.map >> r.truth) all.push_back(r);
  }
  if (all.empty()) throw std::runtime_error(path + ": no recordings");
  return all;
}

const Sample& Good(const Recording& r) {
  static std::map<std::string, Sample> samples;
  const auto found = samples.find(r.name);
  return found != samples.end()
             ? found->second
             : samples.emplace(r.name, LoadSample(r.log, r.rig, r.map, r.truth)).first->second;
}

struct Count {
  int n = 0, named = 0;
};

Count Try(const RandomFault& kind, int times, const std::vector<Recording>& recordings, Chance* chance) {
  Count count;
  // Some kinds do not suit every recording; one that suits none must not be tried forever.
  for (int tries = 0; count.n < times && tries < 100 * times; ++tries) {
    const Recording& recording =
        recordings[static_cast<std::size_t>(Pick(chance, static_cast<int>(recordings.size())))];
    Sample sick = Good(recording);
    const std::string what = kind.make(&sick, chance);
    if (what.empty()) continue;
    std::string said;
    const std::clock_t begin = std::clock();
    const bool named = IsNamed(kind.checks, ExamineSample(sick), &said);
    ++count.n, count.named += named ? 1 : 0;
    std::fprintf(stderr, "%s %s: %s, in %s (%.1f s):\n%s\n", named ? "named" : "MISSED", kind.kind.c_str(),
                 what.c_str(), recording.name.c_str(),
                 static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, said.c_str());
  }
  return count;
}

int Run(unsigned seed, int times, const std::string& recordings_file, const std::string& only) {
  const std::vector<Recording> recordings = ReadRecordings(recordings_file);
  Count all;
  std::printf("| kind | faults | named first or second |\n|---|---|---|\n");
  for (const RandomFault& kind : RandomFaults()) {
    Chance chance(seed++);  // of its own for each kind: one alone does the same as among all
    if (kind.kind.find(only) == std::string::npos) continue;
    const Count count = Try(kind, times, recordings, &chance);
    std::printf("| %s | %d | %d |\n", kind.kind.c_str(), count.n, count.named);
    std::fflush(stdout);
    all.n += count.n, all.named += count.named;
  }
  if (all.n == 0) throw std::runtime_error("no faults were put in: see KIND, TIMES and the recordings");
  std::printf("| all | %d | %d |\n", all.n, all.named);
  return all.named >= 0.95 * all.n ? 0 : 1;
}

}  // namespace
}  // namespace evit::doctor

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: doctor_trial SEED TIMES RECORDINGS [KIND]\n");
    return 2;
  }
  try {
    return evit::doctor::Run(static_cast<unsigned>(std::atoi(argv[1])), std::atoi(argv[2]), argv[3],
                             argc > 4 ? argv[4] : "");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "doctor_trial: %s\n", e.what());
    return 2;
  }
}
