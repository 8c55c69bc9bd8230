#include "common/localization/place_index_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/helpers/synthetic_room.h"

namespace evit {
namespace {

namespace fs = std::filesystem;

class PlaceIndexFileTest : public ::testing::Test {
 protected:
  PlaceIndexFileTest() {
    char name[] = "/tmp/evit_places_XXXXXX";
    folder_ = mkdtemp(name);
    path_ = PlaceIndexPaths(folder_ / "map.pcd").front();
    const PointMap room = synthetic::WalledRoom(1);
    for (std::size_t k = 0; k < room.points.size(); k += 8) map_.points.push_back(room.points[k]);
    options_.grid.max_places = 200;
    options_.min_visible = 5;
  }
  ~PlaceIndexFileTest() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }
  // Whether it was read.
  bool Load(PlaceIndex* index = nullptr) {
    bool read = false;
    PlaceIndex loaded = ReadOrMakePlaceIndex(paths_.empty() ? std::vector<std::string>{path_} : paths_, map_,
                                             options_, nullptr, &read);
    EXPECT_FALSE(loaded.places().empty());
    if (index != nullptr) *index = std::move(loaded);
    return read;
  }

  fs::path folder_;
  std::string path_;
  std::vector<std::string> paths_;  // empty: path_ alone
  PointMap map_;
  PlaceIndexOptions options_;
};

TEST_F(PlaceIndexFileTest, WhatIsReadIsWhatWasMade) {
  PlaceIndex made(0, {}, {}), read(0, {}, {});
  EXPECT_FALSE(Load(&made));
  EXPECT_TRUE(Load(&read));
  ASSERT_EQ(made.places().size(), read.places().size());
  ASSERT_EQ(made.n_edges(), read.n_edges());
  EXPECT_EQ(made.spacing(), read.spacing());
  EXPECT_EQ(std::memcmp(made.edges(), read.edges(), made.n_edges() * sizeof(PlaceIndex::Edge)), 0);
  for (std::size_t k = 0; k < made.places().size(); ++k) {
    EXPECT_EQ(made.places()[k].at, read.places()[k].at);
    EXPECT_EQ(made.places()[k].end, read.places()[k].end);
  }
  EXPECT_FALSE(fs::exists(path_ + ".part"));
}

TEST_F(PlaceIndexFileTest, AnotherMapOrOtherOptionsMakeItAgain) {
  Load();
  map_.points.back().x() += 1e-4F;
  EXPECT_FALSE(Load());
  EXPECT_TRUE(Load());
  options_.grid.spacing *= 1.5;
  EXPECT_FALSE(Load());
}

TEST_F(PlaceIndexFileTest, ADamagedFileIsMadeAgain) {
  Load();
  const auto size = fs::file_size(path_);
  for (const std::uintmax_t at : {std::uintmax_t{20}, std::uintmax_t{41}, size / 2, size - 1}) {
    {
      std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(static_cast<std::streamoff>(at));
      const int byte = file.get();
      file.seekp(static_cast<std::streamoff>(at));
      file.put(static_cast<char>(byte ^ 0x10));
    }
    EXPECT_FALSE(Load()) << at;
    EXPECT_TRUE(Load());
  }
  for (const std::uintmax_t left : {std::uintmax_t{0}, std::uintmax_t{30}, size - 2}) {
    fs::resize_file(path_, left);
    EXPECT_FALSE(Load()) << left;
  }
}

TEST_F(PlaceIndexFileTest, WhereItCannotBeKeptItIsMadeEachTime) {
  path_ = folder_ / "none" / "map.pcd.places";
  EXPECT_FALSE(Load());
  EXPECT_FALSE(Load());
  bool read = false;
  ReadOrMakePlaceIndex({}, map_, options_, nullptr, &read);
  EXPECT_FALSE(read);
}

TEST_F(PlaceIndexFileTest, WhereTheMapsFolderCannotBeWrittenItIsKeptInTheCache) {
  setenv("CACHE_DIRECTORY", (folder_ / "cache" / "evit").c_str(), 1);
  paths_ = PlaceIndexPaths("/proc/map.pcd");  // nobody can write there
  ASSERT_EQ(paths_.size(), 2U);
  EXPECT_EQ(fs::path(paths_[1]).parent_path(), folder_ / "cache" / "evit");
  EXPECT_NE(paths_[1], PlaceIndexPaths("/sys/map.pcd")[1]);
  EXPECT_EQ(KeptPlaceIndexText("/proc/map.pcd"), "");
  EXPECT_FALSE(Load());
  EXPECT_TRUE(Load());
  EXPECT_TRUE(fs::exists(paths_[1]));
  EXPECT_EQ(KeptPlaceIndexText("/proc/map.pcd").rfind(paths_[1] + " (", 0), 0U);
  unsetenv("CACHE_DIRECTORY");
}

}  // namespace
}  // namespace evit
