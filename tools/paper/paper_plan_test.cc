#include "tools/paper/paper_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/helpers/paper.h"
#include "tests/helpers/paths.h"
#include "tools/paper/index.h"
#include "tools/paper/selection.h"

namespace evit::paper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class PlanTest : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.config = test::SourcePath("config/paper.textproto");
    options_.programs = test::ProgramPath("");
    options_.out = folder_ / "out";
  }
  // Names of the jobs that begin with `what`.
  static int Count(const std::vector<PaperJob>& jobs, const std::string& what) {
    return static_cast<int>(
        std::count_if(jobs.begin(), jobs.end(), [&](const PaperJob& j) { return j.id.rfind(what, 0) == 0; }));
  }
  void WriteRecorded(const std::string& name) const {
    for (const char* end : {"left_event.hdf5", "imu.txt", "gt.txt"})
      folder_.Write("vector/" + name + "1.synced." + end, "x");
  }

  TestFolder folder_{"paper_plan"};
  PaperOptions options_;
};

TEST_F(PlanTest, HasEverySequenceInEveryRoomWithEveryMethod) {
  const PaperPlan plan = MakePlan(options_);
  const int methods = static_cast<int>(AllMethods(plan.config).size());
  const auto jobs = JobsOf(plan);
  EXPECT_EQ(Count(jobs, "simulate "), 18);
  EXPECT_EQ(Count(jobs, "run "), 18 * methods);
  EXPECT_EQ(Count(jobs, "figures "), 1);
  for (const PaperJob& job : jobs) {
    if (Count({job}, "simulate ") == 1) continue;
    ASSERT_EQ(job.needs.size(), 1U) << job.id;
    EXPECT_EQ(Count({jobs[job.needs[0]]}, "simulate ") + Count({jobs[job.needs[0]]}, "map "), 1) << job.id;
  }
  EXPECT_TRUE(CollectResults(plan).runs.empty());
}

TEST_F(PlanTest, QuickIsOneRoomAndMakesRecordingsOfItsOwn) {
  const auto slow = JobsOf(MakePlan(options_));
  options_.quick = true;
  const auto quick = JobsOf(MakePlan(options_));
  EXPECT_EQ(Count(quick, "simulate "), 6);
  EXPECT_NE(slow[0].folder, quick[0].folder);
  options_.seeds = 2;
  EXPECT_EQ(Count(JobsOf(MakePlan(options_)), "simulate "), 12);
}

TEST_F(PlanTest, OnlyNarrowsByTableSequenceAndMethod) {
  options_.only = {"II", "EVIT"};
  auto jobs = JobsOf(MakePlan(options_));
  EXPECT_EQ(Count(jobs, "simulate "), 9);
  EXPECT_EQ(Count(jobs, "run "), 9);
  options_.only = {"EVT", "desk_fast", "robot_normal"};
  jobs = JobsOf(MakePlan(options_));
  EXPECT_EQ(Count(jobs, "simulate "), 6);
  EXPECT_EQ(Count(jobs, "run "), 18);
  EXPECT_EQ(Count(jobs, "figures "), 0);
  options_.only = {"III"};
  EXPECT_EQ(Count(JobsOf(MakePlan(options_)), "run "), 54);
  options_.only = {"III", "EVT"};
  EXPECT_THAT([&] { MakePlan(options_); }, ThrowsMessage<std::runtime_error>(HasSubstr("no run matches")));
  options_.only = {"sofa"};
  EXPECT_THAT([&] { MakePlan(options_); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("--only sofa"), HasSubstr("sofa_fast"))));
}

TEST_F(PlanTest, KeysChangeWithWhatTheyDependOn) {
  const auto before = JobsOf(MakePlan(options_));
  EXPECT_EQ(before[1].key, JobsOf(MakePlan(options_))[1].key);
  // The same tracker, but for one figure.
  std::filesystem::copy(test::SourcePath("config"), folder_ / "config",
                        std::filesystem::copy_options::recursive);
  options_.config = folder_ / "config/paper.textproto";
  std::ifstream in(folder_ / "config/tracker.textproto");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  folder_.Write("config/tracker.textproto", text + "\nkeyframes { n_event: 30001 }\n");
  const auto after = JobsOf(MakePlan(options_));
  for (std::size_t k = 0; k < before.size(); ++k) {
    const bool other_file =
        before[k].id.find(" evt") != std::string::npos || before[k].id.find(" evpt") != std::string::npos;
    // The rig has another path, and so has a new recording; settings are compared apart from that.
    const auto settings_of = [](const PaperJob& job) { return job.key.substr(job.key.find('\n')); };
    if (before[k].id.rfind("run ", 0) != 0) continue;
    EXPECT_EQ(settings_of(before[k]) == settings_of(after[k]), other_file) << before[k].id;
  }
}

TEST_F(PlanTest, PrefersRecordedSequences) {
  WriteRecorded("desk_normal");
  WriteRecorded("sofa_fast/sofa_fast");
  folder_.Write("vector/desk.ply", "x");
  folder_.Write("vector/sofa.txt", "x");
  options_.vector = folder_ / "vector";
  const PaperPlan plan = MakePlan(options_);
  EXPECT_EQ(Count(JobsOf(plan), "import "), 2);
  EXPECT_EQ(Count(JobsOf(plan), "simulate "), 12);
  const auto desk = std::find_if(plan.recordings.begin(), plan.recordings.end(),
                                 [](const Recording& r) { return r.name == "desk_normal.recorded"; });
  ASSERT_NE(desk, plan.recordings.end());
  EXPECT_EQ(desk->map, folder_ / "vector/desk.ply");
  EXPECT_THAT(desk->job.key, HasSubstr("desk_normal1.synced.left_event.hdf5 1 bytes"));
}

TEST_F(PlanTest, MakesTheMapThatASequenceLacksOfItsPictures) {
  WriteRecorded("desk_normal");
  std::filesystem::create_directories(folder_ / "vector/desk_normal1.synced.left_camera");
  options_.vector = folder_ / "vector";
  const auto jobs = JobsOf(MakePlan(options_));
  const auto import =
      std::find_if(jobs.begin(), jobs.end(), [](const PaperJob& j) { return j.id[0] == 'i'; });
  ASSERT_NE(import, jobs.end());
  const auto commands = import->prepare();
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_THAT(commands[1], ::testing::IsSupersetOf({std::string("build"), std::string("body")}));
  const auto camera = std::find(commands[1].begin(), commands[1].end(), "--camera");
  EXPECT_TRUE(std::filesystem::exists(*(camera + 1))) << *(camera + 1);
}

TEST_F(PlanTest, MakesAMapOfABagOfPictures) {
  for (const char* end : {"left_event", "imu", "gt", "left_camera"})
    folder_.Write("vector/robot_fast1.synced." + std::string(end) + ".bag", "x");
  options_.vector = folder_ / "vector";
  const auto jobs = JobsOf(MakePlan(options_));
  const auto import =
      std::find_if(jobs.begin(), jobs.end(), [](const PaperJob& j) { return j.id[0] == 'i'; });
  ASSERT_NE(import, jobs.end());
  const auto commands = import->prepare();
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_THAT(commands[0], ::testing::Not(::testing::Contains(HasSubstr("left_camera"))));
  EXPECT_THAT(commands[1], ::testing::Contains(folder_ / "vector/robot_fast1.synced.left_camera.bag"));
}

TEST_F(PlanTest, FindsBags) {
  for (const char* end : {"left_event", "imu", "gt"})
    folder_.Write("vector/robot_fast1.synced." + std::string(end) + ".bag", "x");
  folder_.Write("vector/robot.pcd", "x");
  options_.vector = folder_ / "vector";
  const auto jobs = JobsOf(MakePlan(options_));
  const auto import =
      std::find_if(jobs.begin(), jobs.end(), [](const PaperJob& j) { return j.id[0] == 'i'; });
  ASSERT_NE(import, jobs.end());
  const auto words = import->prepare().at(0);
  EXPECT_EQ(words.at(2), "bag");
  EXPECT_THAT(words.at(5), HasSubstr("gt.bag"));
}

TEST_F(PlanTest, MissingFilesOfARecordedSequenceAreNamed) {
  WriteRecorded("desk_normal");
  options_.vector = folder_ / "vector";
  EXPECT_THAT([&] { MakePlan(options_); },
              ThrowsMessage<std::runtime_error>(HasSubstr("desk.pcd, .ply or .txt")));
  folder_.Write("vector/desk.pcd", "x");
  std::filesystem::remove(folder_ / "vector/desk_normal1.synced.gt.txt");
  EXPECT_THAT([&] { MakePlan(options_); },
              ThrowsMessage<std::runtime_error>(HasSubstr("gt.txt: is missing")));
  std::filesystem::remove_all(folder_ / "vector");
  EXPECT_THAT([&] { MakePlan(options_); }, ThrowsMessage<std::runtime_error>(HasSubstr("no such folder")));
  std::filesystem::create_directories(folder_ / "vector");
  EXPECT_THAT([&] { MakePlan(options_); }, ThrowsMessage<std::runtime_error>(HasSubstr("holds no sequence")));
}

TEST_F(PlanTest, IndexDescribesResultsAndTheirOrigin) {
  const PaperPlan plan = MakePlan(options_);
  EXPECT_THAT(CollectResults(plan).sources, ::testing::IsEmpty()) << "nothing has run";
  PaperResults results;
  results.runs[{"desk_fast", "evit"}] = {MadeUpRun(1, 2, 3)};
  IndexFacts facts;
  results.sources["desk_fast"] = "made up";
  facts.command = "evit paper --out x";
  facts.commit = "abc";
  facts.machine = DescribeMachine();
  facts.outcome.failures.push_back({"run a", "exit code 1"});
  const std::string text = IndexText(plan, results, {{"window.png", "a window"}, {"", "not drawn"}}, facts);
  for (const char* what :
       {"evit paper --out x", "commit: abc", "Table II.", "| desk_fast | EVIT | (dyn) | 1.00 |",
        "figures/window.png", "| desk_fast | made up |", "run a: exit code 1", "motion_model PREVIOUS_POSE"})
    EXPECT_THAT(text, HasSubstr(what));
  EXPECT_EQ(text.find("Table I."), std::string::npos);
  EXPECT_EQ(text.find("| sofa_fast |"), std::string::npos) << "a sequence that has not run";
}

}  // namespace
}  // namespace evit::paper
