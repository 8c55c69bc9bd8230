// The doctor on real recordings: nothing wrong with good ones; and of faults put into them, most are named
// first or second. Skipped where there are none (EVIT_SHARED_DATA). Faults and pieces of recordings take a
// minute of computing and are looked at with EVIT_REAL_FAULTS=1, each fault in one recording; =all: in all;
// =NAME: those whose name has it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "common/config/rig_file.h"
#include "tests/helpers/doctor_faults.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/rpg/rpg_import.h"
#include "tools/formats/vector/sequence_import.h"

namespace evit::doctor {
namespace {

using diagnosis::Finding;
using diagnosis::Severity;

constexpr double kSeconds = 2.5;

std::string Shared() {
  const char* folder = std::getenv("EVIT_SHARED_DATA");
  return folder != nullptr ? folder : test::SourcePath("../shared/data");
}

struct Recording {
  std::string name;
  Sample sample;
};

Sample Clip(const TemporaryFolder& folder, const std::string& name, double seconds) {
  const std::string dir = Shared() + "/vector/previews/" + name;
  formats::SequenceImport job;
  job.folder = dir;
  job.name = name;
  job.rig = LoadRig(dir + "/rig.textproto");
  job.out = folder.File(name);
  formats::ImportSequence(job, [](double) {});
  return LoadSample(job.out, dir + "/rig.textproto", dir + "/map.pcd", dir + "/truth_imu.tum", seconds);
}

Sample Davis(const TemporaryFolder& folder, const std::string& map) {
  const std::string dir = Shared() + "/davis240b/";
  formats::RpgImport job;
  job.folder = dir + "seq2";
  job.width = 190;
  job.height = 180;
  job.truth_of_body = true;
  job.out = folder.File("davis");
  formats::ImportRpg(job, [](double) {});
  return LoadSample(job.out, dir + "seq2/rig.textproto", dir + map, job.out + ".truth.tum");
}

std::vector<Recording> Recordings(double seconds) {
  const TemporaryFolder folder("doctor_real");
  std::vector<Recording> all;
  for (const char* clip : {"desk_normal", "robot_normal", "mountain_normal"})
    all.push_back({clip, Clip(folder, clip, seconds)});
  for (const char* map : {"map_full.pcd", "map_early.pcd"})
    all.push_back({std::string("davis240b, ") + map, Davis(folder, map)});
  return all;
}

class DoctorRealTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(Shared() + "/vector/previews") ||
        !std::filesystem::is_directory(Shared() + "/davis240b"))
      GTEST_SKIP() << "no recordings in " << Shared() << " (EVIT_SHARED_DATA)";
  }
};

TEST_F(DoctorRealTest, GoodRecordingsHaveNothingWrong) {
  for (const Recording& recording : Recordings(60)) {
    for (const Finding& f : ExamineSample(recording.sample)) {
      EXPECT_EQ(f.severity, Severity::kGood)
          << recording.name << ": " << f.check << ": " << f.what << " (" << f.figure << ")";
    }
  }
}

// Fifteen more recordings: other parts of the same, and with fewer events, as after another threshold.
TEST_F(DoctorRealTest, PiecesOfGoodRecordingsHaveNothingWrong) {
  if (std::getenv("EVIT_REAL_FAULTS") == nullptr) GTEST_SKIP() << "EVIT_REAL_FAULTS is not set";
  const std::vector<Recording> recordings = Recordings(60);
  int n = 0;
  const auto expect_good = [&n](const std::string& name, const Sample& sample) {
    ++n;
    for (const Finding& f : ExamineSample(sample)) {
      EXPECT_EQ(f.severity, Severity::kGood)
          << name << ": " << f.check << ": " << f.what << " (" << f.figure << ")";
    }
  };
  for (const Recording& r : recordings) {
    const double end = ToSeconds(r.sample.events.t.back() - r.sample.events.t.front());
    expect_good(r.name + ", first part", Piece(r.sample, 0, 0.6 * end));
    expect_good(r.name + ", last part", Piece(r.sample, 0.4 * end, end));
    expect_good(r.name + ", two thirds of the events", Thinned(r.sample, 3));
  }
  EXPECT_EQ(n, 15);
}

TEST_F(DoctorRealTest, MostFaultsAreNamedFirstOrSecond) {
  const char* faults = std::getenv("EVIT_REAL_FAULTS");
  if (faults == nullptr) GTEST_SKIP() << "EVIT_REAL_FAULTS is not set";
  const std::vector<Recording> recordings = Recordings(kSeconds);
  const bool all = std::string(faults) == "all";
  int n = 0, n_named = 0;
  std::string missed;
  const std::vector<Fault> list = Faults();
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Fault& fault = list[k];
    if (!all && std::string(faults) != "1" && fault.name.find(faults) == std::string::npos) continue;
    bool done = false;
    for (std::size_t i = 0; i < recordings.size() && (all || !done); ++i) {
      const std::size_t r = (k + i) % recordings.size();
      Sample sick = recordings[r].sample;
      if (fault.applies && !fault.applies(sick)) continue;
      done = true;
      fault.make(&sick);
      std::string said;
      ++n;
      if (IsNamed(fault, ExamineSample(sick), &said)) {
        ++n_named;
      } else {
        missed += fault.name + " in " + recordings[r].name + ":\n" + said;
      }
    }
  }
  std::printf("%d of %d faults named first or second\n%s", n_named, n, missed.c_str());
  EXPECT_GE(n_named, 0.95 * n);
}

}  // namespace
}  // namespace evit::doctor
