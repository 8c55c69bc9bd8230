#include "tools/paper/paper_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/helpers/paper.h"
#include "tools/paper/summary.h"
#include "tools/paper/table_files.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr Alignment kPaper = Alignment::kFirstPair;

TEST(Table, HasThePapersLayoutWithTheBestOfASequenceInBold) {
  PaperResults results;
  results.runs[{"robot_normal", "evt300"}] = {MadeUpRun(0.91, 0.89, 3)};
  results.runs[{"robot_normal", "evt30"}] = {MadeUpRun(1.02, 0.9, 2)};
  results.runs[{"robot_normal", "evit"}] = {MadeUpRun(0.844, 0.8901, 3)};
  results.runs[{"sofa_fast", "evit"}] = {MadeUpRun(9, 4, 3)};
  const paper::Paper config = ShippedPaper();
  const TextTable table = PaperLayout(config, results, PaperTable::kNormal, kPaper);
  ASSERT_EQ(table.rows.size(), 3U);  // what was not run has no row
  EXPECT_THAT(table.rows[0], ElementsAre("robot_normal", "EVT", "300hz", "0.91", "**0.89**", "1.91",
                                         "**0.89**", "2.91", "**0.89**", "50.00", "0.50"));
  EXPECT_THAT(table.rows[1], ElementsAre("robot_normal", "EVT", "30hz", "1.02", "0.90", "2.02", "0.90", "-",
                                         "-", "50.00", "0.50"));
  EXPECT_THAT(table.rows[2], ElementsAre("robot_normal", "EVIT", "(dyn)", "**0.84**", "**0.89**", "**1.84**",
                                         "**0.89**", "**2.84**", "**0.89**", "50.00", "0.50"));
  EXPECT_EQ(table.header.size(), table.rows[0].size());
  const TextTable fast = PaperLayout(config, results, PaperTable::kFast, kPaper);
  ASSERT_EQ(fast.rows.size(), 1U);
  EXPECT_EQ(fast.rows[0][3], "9.00") << "alone, nothing is best";
}

TEST(Table, SeveralSeedsGiveMedianWorstAndReachedMilestones) {
  PaperResults results;
  results.runs[{"desk_fast", "evit"}] = {MadeUpRun(1, 0.1, 3), MadeUpRun(3, 0.3, 3), MadeUpRun(1.5, 0.2, 3)};
  results.runs[{"desk_fast", "evt100"}] = {MadeUpRun(0.5, 0.1, 3), MadeUpRun(0.5, 0.1, 1),
                                           MadeUpRun(0.5, 0.1, 2)};
  const TextTable table = PaperLayout(ShippedPaper(), results, PaperTable::kFast, kPaper);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_THAT(table.rows[0], ElementsAre("desk_fast", "EVT", "100hz", "**0.50** (0.50)", "**0.10** (0.10)",
                                         "- (2/3)", "- (2/3)", "- (1/3)", "- (1/3)", "50.00", "0.50"));
  EXPECT_THAT(table.rows[1],
              ElementsAre("desk_fast", "EVIT", "(dyn)", "1.50 (3.00)", "0.20 (0.30)", "**2.50** (4.00)",
                          "**0.20** (0.30)", "**3.50** (5.00)", "**0.20** (0.30)", "50.00", "0.50"));
}

TEST(Table, MotionModelsShareARowPerSequence) {
  PaperResults results;
  results.runs[{"sofa_fast", "evit_order0"}] = {MadeUpRun(1, 1, 0)};
  results.runs[{"sofa_fast", "evit_order1"}] = {MadeUpRun(1, 3, 3)};
  results.runs[{"sofa_fast", "evit"}] = {MadeUpRun(2, 2, 3)};
  const TextTable table = PaperLayout(ShippedPaper(), results, PaperTable::kMotionModels, kPaper);
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_THAT(table.rows[0], ElementsAre("sofa_fast", "-", "-", "50.00", "0.50", "**3.00**", "3.00", "50.00",
                                         "0.50", "4.00", "**2.00**", "50.00", "0.50"));
  EXPECT_EQ(table.header.size(), table.rows[0].size());
}

TEST(Table, TextFormsAreWellFormed) {
  const TextTable table{{"a", "b"}, {{"1,5", "say \"so\""}}};
  EXPECT_EQ(table.Markdown(), "| a | b |\n|---|---|\n| 1,5 | say \"so\" |\n");
  EXPECT_EQ(table.Csv(), "a,b\r\n\"1,5\",\"say \"\"so\"\"\"\r\n");
}

TEST(Table, FilesFollowTheirRows) {
  const TestFolder folder("paper_tables");
  const paper::Paper config = ShippedPaper();
  PaperResults results;
  results.sources["sofa_fast"] = "made up";
  results.runs[{"sofa_fast", "evit"}] = {MadeUpRun(2, 2, 3), MadeUpRun(4, 2, 2)};
  results.runs[{"sofa_fast", "evit"}][1].lost = "after 3.00 s: no events";
  EXPECT_EQ(WriteTables(folder.path(), config, results).size(), 6U);  // II and III, three alignments each
  const auto json = nlohmann::json::parse(ReadText(folder / "fast.umeyama.json"));
  const auto& row = json.at("rows").at(0);
  EXPECT_EQ(row.at("source"), "made up");
  EXPECT_DOUBLE_EQ(row.at("30%").at("position_cm").at("median"), 3);
  EXPECT_DOUBLE_EQ(row.at("30%").at("position_cm").at("worst"), 4);
  EXPECT_EQ(row.at("100%").at("reached"), 1);
  EXPECT_FALSE(row.at("100%").contains("position_cm"));
  EXPECT_TRUE(row.at("runs").at(1).at("100%").is_null());
  const std::string csv = ReadText(folder / "fast.none.csv");
  EXPECT_THAT(csv, HasSubstr("sofa_fast,made up,evit,EVIT,(dyn),2,2,3,4,2,2,2,4,5,2,2,1,,,,,50,0.5,0.5\r\n"));
  EXPECT_THAT(Losses(config, results), ElementsAre("sofa_fast 2, evit: after 3.00 s: no events"));
  EXPECT_TRUE(WriteTables(folder.path(), config, {}).empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "fast.umeyama.json"));
}

TEST(Summary, MedianOfAnEvenNumberIsTheMeanOfTheMiddle) {
  const Spread spread = SpreadOf({4, 1, 3, 10});
  EXPECT_DOUBLE_EQ(spread.median, 3.5);
  EXPECT_DOUBLE_EQ(spread.worst, 10);
}

}  // namespace
}  // namespace evit::paper
