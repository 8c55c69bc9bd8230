#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "tests/helpers/all_events.h"
#include "tools/formats/hdf5/event_file_writer.h"
#include "tools/formats/hdf5/h5_recording.h"

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class EventFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("event_file_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  static EventArray Events(int n) {
    std::mt19937 rng(1);
    EventArray events;
    Utime t = kOffset + 5;
    for (int k = 0; k < n; ++k) {
      t += static_cast<Utime>(rng() % 7);
      events.push_back(t, rng() % 640, rng() % 480, rng() % 2);
    }
    return events;
  }
  std::string Write(const EventArray& events) {
    std::string path = Path("events.hdf5");
    EventFileWriter writer(path, kOffset);
    writer.Append(events);
    writer.Close();
    return path;
  }
  static constexpr Utime kOffset = 1'642'661'138'836'530;
  std::filesystem::path folder_;
};

EventArray ReadAll(const std::string& path) {
  H5Recording recording({path}, "");
  return AllEvents(&recording, 640, 480);
}

TEST_F(EventFileTest, WhatIsWrittenReadsBack) {
  const EventArray events = Events(300'000);
  const std::string path = Write(events);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  const EventArray all = ReadAll(path);
  EXPECT_EQ(all.t, events.t);
  EXPECT_EQ(all.x, events.x);
  EXPECT_EQ(all.y, events.y);
  EXPECT_EQ(all.p, events.p);
}

TEST_F(EventFileTest, MillisecondIndexPointsAtFirstEvents) {
  const EventArray events = Events(20'000);
  const std::string path = Write(events);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "ms_to_idx", H5P_DEFAULT), space = H5Dget_space(dataset);
  std::vector<std::uint64_t> index(H5Sget_simple_extent_npoints(space));
  H5Dread(dataset, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, index.data());
  H5Sclose(space), H5Dclose(dataset), H5Fclose(file);
  for (std::size_t ms = 0; ms + 1 < index.size(); ++ms) {
    const Utime begin = kOffset + static_cast<Utime>(ms) * 1000;
    const auto first = std::lower_bound(events.t.begin(), events.t.end(), begin) - events.t.begin();
    ASSERT_EQ(index[ms], static_cast<std::uint64_t>(first)) << ms;
  }
  EXPECT_EQ(index.back(), events.size());
}

TEST_F(EventFileTest, TruncatedFilesAreRefusedAtAnyLength) {
  const std::string path = Write(Events(200'000));
  const auto size = std::filesystem::file_size(path);
  for (const double share : {0.0, 0.001, 0.1, 0.5, 0.9, 0.999}) {
    const std::string cut = Path("cut.hdf5");
    std::filesystem::copy_file(path, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    EXPECT_THAT([&] { ReadAll(cut); }, ThrowsMessage<std::runtime_error>(HasSubstr("cut.hdf5"))) << share;
  }
}

TEST_F(EventFileTest, DamagedChunkIsNamed) {
  const std::string path = Write(Events(300'000));
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    // Over several chunks: a damaged frame header is noticed; damaged bytes within a chunk may pass,
    // Zstandard frames carry no checksum here.
    const auto size = std::filesystem::file_size(path);
    file.seekp(static_cast<std::streamoff>(size / 4));
    file << std::string(size / 2, 'x');
  }
  EXPECT_THAT([&] { ReadAll(path); }, ThrowsMessage<std::runtime_error>(HasSubstr("events.hdf5")));
}

TEST_F(EventFileTest, MissingDatasetIsNamed) {
  const std::string path = Path("empty.hdf5");
  H5Fclose(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_THAT([&] { ReadAll(path); }, ThrowsMessage<std::runtime_error>(HasSubstr("holds no events")));
  EXPECT_THAT([&] { ReadAll(Path("none.hdf5")); }, ThrowsMessage<std::runtime_error>(HasSubstr("none.hdf5")));
}

TEST_F(EventFileTest, OutOfOrderIsRefusedWithTheIndex) {
  EventArray events = Events(100);
  events.t[60] = events.t[10];
  EXPECT_THAT([&] { Write(events); }, ThrowsMessage<std::runtime_error>(HasSubstr("event 60")));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));  // nothing half-written
}

TEST_F(EventFileTest, UnwritableFolderIsNamed) {
  EXPECT_THAT([&] { EventFileWriter writer(Path("no/such/folder.hdf5"), 0); },
              ThrowsMessage<std::runtime_error>(HasSubstr("folder.hdf5")));
}

// A file may not grow beyond so many bytes: as on a full disk. In a process of its own, down to its exit.
TEST(EventFileWriterDeathTest, AFullDiskIsAnErrorAndNoCrash) {
  const auto fill = [] {
    const rlimit limit = {100'000, 100'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    const std::string path = (std::filesystem::temp_directory_path() / "event_file_full.h5").string();
    int code = 1;
    try {
      EventFileWriter writer(path, 0);
      std::mt19937 rng(1);
      EventArray events;
      for (Utime t = 0; t < 1'000'000; t += 1 + static_cast<Utime>(rng() % 3))
        events.push_back(t, static_cast<std::uint16_t>(rng()), static_cast<std::uint16_t>(rng()),
                         static_cast<std::uint8_t>(rng() % 2));
      writer.Append(events);
      writer.Close();
    } catch (const std::runtime_error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      code = std::filesystem::exists(path + ".part") ? 3 : 2;
    }
    std::exit(code);
  };
  EXPECT_EXIT(fill(), ::testing::ExitedWithCode(2), "event_file_full.h5");
}

}  // namespace
}  // namespace evit::formats
