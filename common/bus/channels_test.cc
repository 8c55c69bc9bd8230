// Keeps docs/reference/channels.md, common/bus/channels.h and lcmtypes/ true to each other.
#include "common/bus/channels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "evit/messages.hpp"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

namespace fs = std::filesystem;

std::string ReadFile(const fs::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> Matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i) found.push_back((*i)[1]);
  return found;
}

struct Row {
  std::string channel, type, sender, receivers, rate, meaning;
};

std::vector<Row> Table() {
  std::istringstream text(ReadFile(test::SourcePath("docs/reference/channels.md")));
  std::vector<Row> rows;
  for (std::string line; std::getline(text, line);) {
    std::smatch m;
    const std::regex row(R"(\| `([A-Z_]+)` \| `(\w+)` \| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|)");
    if (std::regex_match(line, m, row)) rows.push_back({m[1], m[2], m[3], m[4], m[5], m[6]});
  }
  return rows;
}

/// The channel names as the header's initialisers spell them: a new one cannot be forgotten here.
std::set<std::string> ChannelsOfHeader() {
  const auto names =
      Matches(ReadFile(test::SourcePath("common/bus/channels.h")), R"(prefix \+ "([A-Z_]+)\")");
  return {names.begin(), names.end()};
}

std::set<std::string> MessageTypes() {
  std::set<std::string> types;
  for (const auto& file : fs::directory_iterator(test::SourcePath("lcmtypes"))) {
    if (file.path().extension() == ".lcm") types.insert(file.path().stem());
  }
  return types;
}

TEST(ChannelsDocument, ListsEveryChannelOnceAndNoOther) {
  std::multiset<std::string> listed;
  for (const Row& row : Table()) listed.insert(row.channel);
  const std::set<std::string> expected = ChannelsOfHeader();
  EXPECT_GE(expected.size(), 13U);
  EXPECT_EQ(listed, (std::multiset<std::string>(expected.begin(), expected.end())));
}

TEST(ChannelsDocument, NamesOnlyTypesThatExistAndAllOfThem) {
  const std::set<std::string> types = MessageTypes();
  std::set<std::string> mentioned;
  for (const Row& row : Table()) mentioned.insert(row.type);
  const std::string text = ReadFile(test::SourcePath("docs/reference/channels.md"));
  for (const std::string& type : Matches(text, R"(`(\w+_t)`)")) mentioned.insert(type);
  EXPECT_EQ(mentioned, types);
}

TEST(ChannelsDocument, TheTableHasAllMessages) {
  std::set<std::string> messages, in_table;
#define EVIT_INSERT(MESSAGE) messages.insert(#MESSAGE);
  EVIT_MESSAGES(EVIT_INSERT)
#undef EVIT_INSERT
  for (const Row& row : Table()) in_table.insert(row.type);
  EXPECT_EQ(in_table, messages);
}

TEST(Channels, ThePrefixGoesInFrontOfEachName) {
  const Channels plain, prefixed("left/");
  const auto all = [](const Channels& c) {
    return std::vector<std::string>{c.events,       c.imu,        c.ground_truth,   c.keyframe,
                                    c.map_query,    c.map_points, c.window_state,   c.body_pose,
                                    c.tracker_mode, c.status,     c.replay_control, c.credit,
                                    c.stream_end,   c.pose_hint,  c.view_query,     c.map_view,
                                    c.place_query,  c.places,     c.place_prior};
  };
  const std::vector<std::string> names = all(plain), with_prefix = all(prefixed);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()), ChannelsOfHeader());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(with_prefix[i], "left/" + names[i]);
}

}  // namespace
}  // namespace evit
