// The whole way once, as short as it gets: a clip of two seconds, one method, figures; then again, with
// nothing to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/helpers/paper.h"
#include "tests/helpers/paths.h"
#include "tools/paper/text_files.h"

namespace evit::commands {
namespace {

using ::testing::HasSubstr;

TEST(PaperCommand, ProducesTablesAndFiguresOnce) {
  const TestFolder folder("paper_command");
  const std::string config = test::SourcePath("config/");
  folder.Write("paper.textproto", "simulated_s: 2.5 quick_s: 2 seeds: 1 rig: \"" + config +
                                      "vector/rig.textproto\"\n"
                                      "method { id: \"evit\" name: \"EVIT\" frequency: \"(dyn)\" config: \"" +
                                      config +
                                      "tracker.textproto\" }\n"
                                      "figure_method: \"evit\" figure_sequence: \"desk_normal\"\n"
                                      "sequence { name: \"desk_normal\" scene: \"desk\" fast: false\n"
                                      "  simulated { builtin: \"builtin:desk_normal\" } }\n");
  const auto run = [&] {
    const std::string command = test::ProgramPath("evit") + " paper --config " +
                                (folder / "paper.textproto") + " --out " + (folder / "out") + " >" +
                                (folder / "said") + " 2>&1";
    return std::system(command.c_str());
  };
  ASSERT_EQ(run(), 0) << paper::ReadText(folder / "said");
  EXPECT_THAT(paper::ReadText(folder / "said"), HasSubstr("3 jobs done, 0 kept, 0 failed"));
  const auto json = nlohmann::json::parse(paper::ReadText(folder / "out/tables/normal.none.json"));
  const auto& row = json.at("rows").at(0);
  EXPECT_EQ(row.at("100%").at("reached"), 1);
  EXPECT_LT(row.at("100%").at("position_cm").at("median").get<double>(), 2);
  EXPECT_GT(row.at("cpu_s_per_s").at("median").get<double>(), 0.05);
  for (const char* figure : {"trajectories.png", "motion_models.png", "window.png"})
    EXPECT_GT(std::filesystem::file_size(folder / ("out/figures/" + std::string(figure))), 10'000U) << figure;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "out"))
    EXPECT_NE(entry.path().extension(), ".hdf5") << "bulky and in the log already";
  ASSERT_EQ(run(), 0) << paper::ReadText(folder / "said");
  EXPECT_THAT(paper::ReadText(folder / "said"), HasSubstr("0 jobs done, 3 kept, 0 failed"));
}

TEST(PaperCommand, BadSelectionFailsBeforeAnyWork) {
  const TestFolder folder("paper_command_wrong");
  const std::string command = test::ProgramPath("evit") + " paper --only nowhere --out " + (folder / "out") +
                              " >" + (folder / "said") + " 2>&1";
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_THAT(paper::ReadText(folder / "said"), HasSubstr("--only nowhere"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace evit::commands
