#include "tools/evit/usage_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace evit::commands {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// What is said about a command line of a program with `track --log L --rig R [--speed S]` and `map info`.
std::string Said(const std::string& arguments) {
  CLI::App app("a program");
  app.require_subcommand(1);
  std::string log, rig;
  double speed = 1, size = 1;
  int count = 3;
  CLI::App* track = app.add_subcommand("track", "tracks");
  track->add_option("--log", log)->required();
  track->add_option("--rig", rig)->required();
  track->add_option("--speed", speed);
  track->add_option("--size", size)->check(CLI::PositiveNumber);
  track->add_option("--count", count)->check(CLI::Range(3, 5000));
  CLI::App* map = app.add_subcommand("map", "maps");
  map->require_subcommand(1);
  map->add_subcommand("info", "tells");
  testing::internal::CaptureStderr();
  int code = 0;
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    code = SayUsageError(app, error);
  }
  std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(code != 0, !said.empty()) << said;
  return said;
}

TEST(UsageError, NamesAllThatIsMissing) {
  EXPECT_THAT(Said("track"), HasSubstr("evit track: error: missing: --log, --rig\n"));
  EXPECT_EQ(Said("track --log a --rig b"), "");
}

TEST(UsageError, NamesAllThatIsNotKnownAndTheNearestOption) {
  EXPECT_THAT(Said("track --lgo a --rig b c.pcd"),
              AllOf(HasSubstr("not understood: --lgo (did you mean --log?), a, c.pcd"),
                    HasSubstr("missing: --log\n")));
  EXPECT_THAT(Said("track --log a --rig b --loudness"), HasSubstr("not understood: --loudness\n"));
  EXPECT_THAT(Said("track c.pcd"), HasSubstr("a file needs its option before it"));
}

TEST(UsageError, SaysWhatAValueHasToBe) {
  EXPECT_EQ(Said("track --log a --rig b --speed fast"),
            "evit track: error: --speed: 'fast' is not a number\n");
  EXPECT_EQ(Said("track --log a --rig b --speed"),
            "evit track: error: --speed: a number is missing after it\n");
}

TEST(UsageError, SaysARangeInAsManyDigitsAsItNeeds) {
  EXPECT_EQ(Said("track --log a --rig b --size -1"),
            "evit track: error: --size: '-1' is not a number above 0\n");
  EXPECT_EQ(Said("track --log a --rig b --count 2"),
            "evit track: error: --count: '2' is not a whole number from 3 to 5000\n");
}

TEST(UsageError, SaysThatAnOptionWasGivenTwice) {
  EXPECT_EQ(Said("track --log a --log b --rig c"), "evit track: error: --log: given 2 times; give it once\n");
}

TEST(UsageError, NamesTheCommandThatMayBeMeant) {
  CLI::App app("a program");
  app.add_subcommand("import", "imports");
  app.add_subcommand("up", "ups");
  EXPECT_EQ(UnknownCommand(app, "improt"),
            "there is no command \"improt\" (did you mean evit import?); known: import, up");
  EXPECT_EQ(UnknownCommand(app, "xy"), "there is no command \"xy\"; known: import, up");
  EXPECT_THAT(Said("map inof"), HasSubstr("not understood: inof (did you mean info?)"));
}

TEST(UsageError, ACommandOfCommandsByItselfShowsThem) {
  EXPECT_THAT(Said("map"), AllOf(HasSubstr("info"), HasSubstr("tells")));
}

}  // namespace
}  // namespace evit::commands
