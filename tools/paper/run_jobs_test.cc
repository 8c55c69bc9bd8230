#include "tools/paper/run_jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/helpers/paper.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

using ::testing::HasSubstr;

// Jobs that leave a mark in a shared file each time they are done.
class JobTest : public ::testing::Test {
 protected:
  PaperJob Make(const std::string& name, const std::string& key, const std::string& script = "true") {
    PaperJob job;
    job.id = name;
    job.folder = folder_ / name;
    job.key = key;
    const std::string mark = "echo " + name + " >> " + (folder_ / "marks");
    job.prepare = [=] { return PaperJob::Commands{{"/bin/sh", "-c", script}, {"/bin/sh", "-c", mark}}; };
    return job;
  }
  JobsOutcome Run(const std::vector<PaperJob>& jobs, int parallel = 2) {
    return RunJobs(
        jobs, parallel, "", [&](double share, const std::string&) { shown_ = std::max(shown_, share); },
        [this] { return interrupted_; });
  }
  std::string Marks() const {
    return std::filesystem::exists(folder_ / "marks") ? ReadText(folder_ / "marks") : "";
  }

  TestFolder folder_{"paper_jobs"};
  bool interrupted_ = false;
  double shown_ = 0;
};

TEST_F(JobTest, RunAgainOnlyWhenTheirKeyChanges) {
  std::vector<PaperJob> jobs{Make("a", "1"), Make("b", "1")};
  jobs[1].needs = {0};
  const JobsOutcome first = Run(jobs);
  EXPECT_EQ(first.done, 2U);
  EXPECT_EQ(first.kept, 0U);
  EXPECT_EQ(Marks(), "a\nb\n");
  EXPECT_DOUBLE_EQ(shown_, 1);
  const JobsOutcome second = Run(jobs);
  EXPECT_EQ(second.done, 0U);
  EXPECT_EQ(second.kept, 2U);
  EXPECT_EQ(Marks(), "a\nb\n") << "nothing is run twice";
  jobs[1] = Make("b", "2");
  jobs[1].needs = {0};
  WriteText(folder_ / "b/old", "of the old key");
  EXPECT_EQ(Run(jobs).done, 1U);
  EXPECT_EQ(Marks(), "a\nb\nb\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b/old"));
}

TEST_F(JobTest, RunInParallelAfterTheirDependencies) {
  std::vector<PaperJob> jobs{Make("slow", "1", "sleep 2"), Make("after", "1"), Make("beside", "1")};
  jobs[1].needs = {0};
  EXPECT_EQ(Run(jobs).done, 3U);
  EXPECT_EQ(Marks(), "beside\nslow\nafter\n");
}

TEST_F(JobTest, FailureSkipsOnlyDependentJobs) {
  std::vector<PaperJob> jobs{Make("bad", "1", "echo no disk left; exit 3"), Make("needs", "1"),
                             Make("good", "1")};
  jobs[1].needs = {0};
  const JobsOutcome outcome = Run(jobs);
  ASSERT_EQ(outcome.failures.size(), 1U);
  EXPECT_EQ(outcome.failures[0].id, "bad");
  EXPECT_THAT(outcome.failures[0].words, HasSubstr("exit code 3"));
  EXPECT_THAT(outcome.failures[0].words, HasSubstr("no disk left"));
  EXPECT_EQ(Marks(), "good\n");
  EXPECT_FALSE(IsDone(jobs[0]));
}

TEST_F(JobTest, GoodExitCodesCountAsDone) {
  std::vector<PaperJob> jobs{Make("lost", "1", "exit 2")};
  jobs[0].good_codes = {0, 2};
  EXPECT_TRUE(Run(jobs).failures.empty());
  EXPECT_TRUE(IsDone(jobs[0]));
}

TEST_F(JobTest, FailingFinishIsAFailure) {
  std::vector<PaperJob> jobs{Make("a", "1")};
  jobs[0].finish = [] { throw std::runtime_error("cannot be removed"); };
  const JobsOutcome outcome = Run(jobs);
  ASSERT_EQ(outcome.failures.size(), 1U);
  EXPECT_EQ(outcome.failures[0].words, "cannot be removed");
  EXPECT_FALSE(IsDone(jobs[0]));
}

TEST_F(JobTest, InterruptionKeepsOnlyFinishedJobs) {
  std::vector<PaperJob> jobs{Make("a", "1"), Make("endless", "1", "exec sleep 100")};
  jobs[1].needs = {0};
  const auto begin = std::chrono::steady_clock::now();
  const JobsOutcome outcome = RunJobs(
      jobs, 2, "",
      [&](double, const std::string& note) { interrupted_ = note.find("endless") != std::string::npos; },
      [this] { return interrupted_; });
  EXPECT_TRUE(outcome.interrupted);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  EXPECT_TRUE(IsDone(jobs[0]));
  EXPECT_FALSE(std::filesystem::exists(jobs[1].folder));
  EXPECT_EQ(Marks(), "a\n");
}

}  // namespace
}  // namespace evit::paper
