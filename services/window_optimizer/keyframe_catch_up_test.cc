#include "services/window_optimizer/keyframe_catch_up.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

using Progress = KeyframeCatchUp::Progress;

class CatchUpTest : public ::testing::Test {
 protected:
  void Add(std::int64_t seq, std::int64_t epoch = 3) {
    keyframe_t keyframe{};
    keyframe.seq = seq;
    keyframe.epoch = epoch;
    catch_up_.Add(keyframe, now_);
  }
  std::vector<std::int64_t> Taken() {
    std::vector<std::int64_t> seqs;
    for (const keyframe_t& keyframe : catch_up_.Take()) seqs.push_back(keyframe.seq);
    return seqs;
  }
  KeyframeCatchUp catch_up_{3, 10};
  KeyframeCatchUp::Clock::time_point now_ = KeyframeCatchUp::Clock::now();
};

TEST_F(CatchUpTest, WaitsUntilThereIsNoHole) {
  EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kWaiting);
  Add(14);  // live
  Add(9);   // before the restart
  Add(11);
  Add(13);
  EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kWaiting);
  Add(13);
  Add(12);
  EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kWhole);
  EXPECT_EQ(Taken(), (std::vector<std::int64_t>{11, 12, 13, 14}));
}

TEST_F(CatchUpTest, NothingWasMissed) {
  Add(11);
  EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kWhole);
}

TEST_F(CatchUpTest, GivesUpAfterAWhile) {
  Add(14);
  EXPECT_EQ(catch_up_.ProgressAt(now_ + KeyframeCatchUp::kPatience), Progress::kWaiting);
  EXPECT_EQ(catch_up_.ProgressAt(now_ + 2 * KeyframeCatchUp::kPatience), Progress::kHopeless);
  EXPECT_EQ(Taken(), (std::vector<std::int64_t>{14}));
}

TEST_F(CatchUpTest, GivesUpWhereTheFirstOnesAreGoneThoughOthersComeAgain) {
  Add(15);
  for (int k = 0; k < 6; ++k) {  // 11 is not held any more
    for (std::int64_t seq = 12; seq <= 15; ++seq) Add(seq);
    now_ += KeyframeCatchUp::kPatience / 4;
  }
  EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kHopeless);
}

TEST_F(CatchUpTest, WaitsAsLongAsMissingOnesKeepComing) {
  Add(15);
  for (std::int64_t seq = 11; seq < 15; ++seq) {
    now_ += KeyframeCatchUp::kPatience * 3 / 4;
    EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kWaiting) << seq;
    Add(seq);
  }
  EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kWhole);
}

TEST_F(CatchUpTest, AnotherFrameBuilderHasNoneOfThem) {
  Add(11);
  Add(0, 4);
  EXPECT_EQ(catch_up_.ProgressAt(now_), Progress::kHopeless);
  EXPECT_EQ(Taken(), (std::vector<std::int64_t>{0}));
}

}  // namespace
}  // namespace evit
