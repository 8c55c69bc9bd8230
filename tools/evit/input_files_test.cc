#include "tools/evit/input_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/helpers/paths.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::commands {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class InputFiles : public ::testing::Test {
 protected:
  static void Refuses(const std::string& option, const std::string& path, const std::string& why) {
    EXPECT_THAT(
        [&] { RequireInput(option, path); },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(option + " " + path + ": "), HasSubstr(why))));
  }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.File(name), std::ios::binary) << text;
    return folder_.File(name);
  }

  const TemporaryFolder folder_{"input_files"};
  const std::string log_ = test::SourcePath("logs/sample.lcmlog"),
                    map_ = test::SourcePath("logs/sample_map.pcd"),
                    rig_ = test::SourcePath("logs/rig.textproto"),
                    truth_ = test::SourcePath("logs/sample_truth.tum"),
                    settings_ = test::SourcePath("config/tracker.textproto");
};

TEST_F(InputFiles, EachFileGoesWhereItBelongsAndNowhereElse) {
  const std::pair<std::string, std::string> files[] = {
      {"--log", log_}, {"--map", map_}, {"--rig", rig_}, {"--truth", truth_}, {"--config", settings_}};
  for (const auto& [option, own] : files) {
    for (const auto& [other, path] : files) {
      // A table may be a map in text.
      if (path == own || (option == "--map" && other == "--truth")) {
        RequireInput(option, path);
      } else {
        Refuses(option, path, "expected ");
      }
    }
  }
  Refuses("--rig", map_, "is a point cloud; expected a rig file");
}

TEST_F(InputFiles, WhatCannotBeReadIsSaid) {
  Refuses("--map", folder_.File("none.pcd"), "there is no such file");
  Refuses("--map", "none.pcd", "looked for in /");
  Refuses("--map", Write("empty.pcd", ""), "is empty");
  RequireInput("--config", Write("empty.textproto", ""));  // all as it is
  RequireInput("--sound", folder_.File("none"));           // of another kind of option
  RequireInput("--map", "");
  RequireInput("--truth", "/dev/null");  // a pipe may come
}

TEST_F(InputFiles, OfAFolderTheFilesThatMayBeMeantAreNamed) {
  Write("trajectory.tum", "# t x y z\n1 0 0 0 0 0 0 1\n");
  Write("covariance.csv", "1,1,1,1\n");
  const std::string folder = folder_.File("trajectory.tum").substr(0, folder_.File("x").size() - 2);
  Refuses("--estimate", folder, "is a folder; give the file in it: " + folder_.File("trajectory.tum") + ";");
  Refuses("--map", folder, "is a folder; give the file in it; expected a map");
}

TEST_F(InputFiles, ContentsAreToldByTheirBegin) {
  EXPECT_EQ(ContentsOf(Write("a", "# a comment\ncam0:\n  rostopic: x\n")), Contents::kRig);
  EXPECT_EQ(ContentsOf(Write("b", "# stamps\nt,x,y,z\n1,2,3,4\n")), Contents::kTable);
  EXPECT_EQ(ContentsOf(Write("c", "evt { }\n")), Contents::kSettings);
  EXPECT_EQ(ContentsOf(Write("d", "\x89PNG\r\n")), Contents::kForeign);
  EXPECT_EQ(ContentsOf(Write("e", "hello world\n")), Contents::kOther);
  EXPECT_EQ(ContentsOf(folder_.File("none")), Contents::kOther);
  const std::string binary = Write("f", std::string("\1\0\2", 3));
  EXPECT_EQ(ContentsOf(binary), Contents::kBinary);
  RequireInput("--log", binary);  // may be damaged
  Refuses("--rig", binary, "is a binary file; expected a rig file");
}

TEST_F(InputFiles, TheOptionsOfAllCommandsAreLookedAt) {
  std::string map, config, recording;
  double speed = 1;
  CLI::App app("a program");
  CLI::App* track = app.add_subcommand("track", "tracks");
  track->add_option("--map", map)->required();
  track->add_option("--speed", speed);
  app.add_subcommand("import", "imports")->add_option("FILE", recording);
  app.add_subcommand("paper", "writes")->add_option("--config", config);
  CheckInputs(&app);
  app.parse("track --map " + map_);
  app.parse("import " + log_);  // recognises files itself
  app.parse("paper --config " + rig_);
  EXPECT_THAT([&] { app.parse("track --map " + rig_); },
              ThrowsMessage<std::runtime_error>(HasSubstr("is a rig")));
  EXPECT_THAT(
      [&] {
        app.parse(std::vector<std::string>{"", "--map", "track"});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("is empty")));
  std::size_t seed = 1;
  CLI::Option* count = track->add_option("--seed", seed);
  CheckInputs(&app);
  EXPECT_THROW(app.parse("track --map " + map_ + " --seed -1"), CLI::ParseError);
  EXPECT_THROW(app.parse(std::vector<std::string>{"", "--seed", map_, "--map", "track"}), CLI::ParseError);
  EXPECT_EQ(count->get_type_name(), "UINT");
  const std::string track_at = "track --map " + map_ + " --speed ";
  for (const char* value : {"nan", "inf", "-inf", "1e999"})
    EXPECT_THROW(app.parse(std::string(track_at).append(value)), CLI::ParseError) << value;
}

}  // namespace
}  // namespace evit::commands
