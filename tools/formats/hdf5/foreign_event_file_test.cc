// Files in VECtor's layout that other programs wrote: other number types, units and filters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <vector>

#include "tests/helpers/all_events.h"
#include "tools/formats/hdf5/h5_recording.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Four events; each column of whatever type.
class ForeignEventFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Create();
    PutPixels();
    Put("events/p", H5T_NATIVE_UINT8, std::vector<std::uint8_t>{0, 1, 1, 0});
    Put("events/t", H5T_NATIVE_UINT32, std::vector<std::uint32_t>{10, 20, 20, 30});
  }
  void TearDown() override {
    Close();
    std::filesystem::remove(path_);
  }
  void Create() {
    Close();
    file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(H5Gcreate2(file_, "events", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }
  void Close() {
    if (file_ >= 0) H5Fclose(file_);
    file_ = -1;
  }
  void PutPixels() {
    Put("events/x", H5T_NATIVE_UINT16, std::vector<std::uint16_t>{1, 2, 3, 4});
    Put("events/y", H5T_NATIVE_UINT16, std::vector<std::uint16_t>{5, 6, 7, 8});
  }
  /// Replaces a dataset.
  template <typename T>
  void Put(const char* name, hid_t type, const std::vector<T>& values, hid_t properties = H5P_DEFAULT) {
    if (H5Lexists(file_, name, H5P_DEFAULT) > 0) H5Ldelete(file_, name, H5P_DEFAULT);
    const hsize_t n = values.size();
    const hid_t space = H5Screate_simple(1, &n, nullptr);
    const hid_t set = H5Dcreate2(file_, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    ASSERT_GE(set, 0) << name;
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set), H5Sclose(space);
  }
  EventArray Read() {
    Close();
    H5Recording recording({path_}, "");
    EventArray events = AllEvents(&recording, 8192, 8192, &dropped_);
    return events;
  }
  void ExpectError(const std::string& a, const std::string& b) {
    EXPECT_THAT([&] { Read(); },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path_), HasSubstr(a), HasSubstr(b))));
    file_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  }
  const std::string path_ = ::testing::TempDir() + "foreign_" + std::to_string(getpid()) + ".h5";
  hid_t file_ = -1;
  DropCounts dropped_;
};

TEST_F(ForeignEventFileTest, TheOffsetMayBeMissingOrOfAnyForm) {
  EXPECT_THAT(Read().t, ElementsAre(10, 20, 20, 30));
  for (const auto& put : std::vector<std::function<void()>>{
           [&] { Put("t_offset", H5T_NATIVE_INT64, std::vector<std::int64_t>{1'642'661'138'000'000}); },
           [&] { Put("t_offset", H5T_NATIVE_DOUBLE, std::vector<double>{1'642'661'138'000'000.0}); },
           [&] { Put("t_offset", H5T_NATIVE_DOUBLE, std::vector<double>{1'642'661'138.0}); }}) {
    SetUp();
    put();
    EXPECT_THAT(Read().t, ElementsAre(1'642'661'138'000'010, 1'642'661'138'000'020, 1'642'661'138'000'020,
                                      1'642'661'138'000'030));
  }
  SetUp();
  Put("t_offset", H5T_NATIVE_INT64, std::vector<std::int64_t>{1, 2});
  ExpectError("t_offset", "expected one");
}

TEST_F(ForeignEventFileTest, PolaritiesOfOneMeaningAreRead) {
  const auto expected = ElementsAre(0, 1, 1, 0);
  Put("events/p", H5T_NATIVE_INT8, std::vector<std::int8_t>{-1, 1, 1, -1});
  EXPECT_THAT(Read().p, expected);
  SetUp();
  Put("events/p", H5T_NATIVE_UINT32, std::vector<std::uint32_t>{4294967295U, 1, 1, 4294967295U});  // v2e
  EXPECT_THAT(Read().p, expected);
  SetUp();
  Put("events/p", H5T_NATIVE_UINT8, std::vector<std::uint8_t>{255, 1, 1, 255});
  EXPECT_THAT(Read().p, expected);
  SetUp();
  Put("events/p", H5T_NATIVE_UINT64, std::vector<std::uint64_t>{~0ULL, 1, 1, ~0ULL});
  EXPECT_THAT(Read().p, expected);
  SetUp();
  Put("events/p", H5T_NATIVE_DOUBLE, std::vector<double>{0, 1, 1, 0});
  EXPECT_THAT(Read().p, expected);
  SetUp();
  const hid_t boolean = H5Tenum_create(H5T_NATIVE_INT8);  // as h5py writes bool
  std::int8_t no = 0, yes = 1;
  H5Tenum_insert(boolean, "FALSE", &no), H5Tenum_insert(boolean, "TRUE", &yes);
  Put("events/p", boolean, std::vector<std::int8_t>{0, 1, 1, 0});
  H5Tclose(boolean);
  EXPECT_THAT(Read().p, expected);
}

TEST_F(ForeignEventFileTest, PolaritiesOfNoOneMeaningAreRefused) {
  Put("events/p", H5T_NATIVE_UINT8, std::vector<std::uint8_t>{1, 2, 2, 1});
  ExpectError("events/p", "the polarity is 2");
  Put("events/p", H5T_NATIVE_INT8, std::vector<std::int8_t>{-1, 0, 1, 1});
  ExpectError("events/p", "0 and -1 both occur");
  Put("events/p", H5T_NATIVE_UINT8, std::vector<std::uint8_t>{255, 0, 255, 0});
  ExpectError("events/p", "0 and 255 both occur");
  Put("events/p", H5T_NATIVE_DOUBLE, std::vector<double>{0, 0.5, 1, 0});
  ExpectError("events/p", "fraction");
}

TEST_F(ForeignEventFileTest, FloatSecondsAreMicroseconds) {
  Put("events/t", H5T_NATIVE_DOUBLE, std::vector<double>{0.00001, 0.00002, 0.00002, 0.00003});
  EXPECT_THAT(Read().t, ElementsAre(10, 20, 20, 30));
  SetUp();
  Put("events/t", H5T_NATIVE_DOUBLE,
      std::vector<double>{1642661138.00001, 1642661138.00002, 1642661138.00002, 1642661138.00003});
  EXPECT_THAT(Read().t, ElementsAre(1'642'661'138'000'010, 1'642'661'138'000'020, 1'642'661'138'000'020,
                                    1'642'661'138'000'030));
  SetUp();
  Put("events/t", H5T_NATIVE_DOUBLE, std::vector<double>{10, 20, 20, 30});  // whole: us
  EXPECT_THAT(Read().t, ElementsAre(10, 20, 20, 30));
  SetUp();
  Put("events/t", H5T_NATIVE_INT64,
      std::vector<std::int64_t>{1642661138000010000, 1642661138000020000, 1642661138000020000,
                                1642661138000030000});  // ns
  EXPECT_THAT(Read().t, ElementsAre(1'642'661'138'000'010, 1'642'661'138'000'020, 1'642'661'138'000'020,
                                    1'642'661'138'000'030));
  SetUp();
  Put("events/t", H5T_NATIVE_DOUBLE, std::vector<double>{1, 2.5, std::nan(""), 3});
  EXPECT_THAT(Read().t, ElementsAre(1'000'000, 2'500'000, 3'000'000));
  EXPECT_EQ(dropped_.invalid, 1);
}

TEST_F(ForeignEventFileTest, ACounterOf32BitsGoesOnWhenItWraps) {
  Put("events/t", H5T_NATIVE_UINT32, std::vector<std::uint32_t>{4294967290U, 4294967295U, 3, 9});
  EXPECT_THAT(Read().t, ElementsAre(4294967290, 4294967295, 4294967299, 4294967305));
}

TEST_F(ForeignEventFileTest, PixelsAreCheckedNotConverted) {
  Put("events/x", H5T_NATIVE_DOUBLE, std::vector<double>{1, 2, 3, 4});
  EXPECT_THAT(Read().x, ElementsAre(1, 2, 3, 4));
  SetUp();
  Put("events/x", H5T_NATIVE_INT16, std::vector<std::int16_t>{1, -2, 3, 4});
  EXPECT_THAT(Read().x, ElementsAre(1, 3, 4));
  EXPECT_EQ(dropped_.outside, 1);
  SetUp();
  Put("events/y", H5T_NATIVE_INT32, std::vector<std::int32_t>{5, 65536 + 6, 7, 8});
  EXPECT_THAT(Read().y, ElementsAre(5, 7, 8));
  SetUp();
  Put("events/x", H5T_NATIVE_DOUBLE, std::vector<double>{1, 2.25, 3, 4});
  ExpectError("events/x", "undistorted");
}

TEST_F(ForeignEventFileTest, WhatIsNoNumberOrNotUnpackedIsNamed) {
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 4);
  Put("events/p", text, std::vector<std::array<char, 4>>(4));
  H5Tclose(text);
  ExpectError("events/p", "holds no numbers");
  // A filter that nobody has.
  const H5Z_class2_t filter{
      H5Z_CLASS_T_VERS,
      32008,
      1,
      1,
      "Bitshuffle, not really",
      nullptr,
      nullptr,
      [](unsigned, std::size_t, const unsigned*, std::size_t n, std::size_t*, void**) { return n; }};
  H5Zregister(&filter);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 4;
  H5Pset_chunk(properties, 1, &chunk);
  H5Pset_filter(properties, 32008, H5Z_FLAG_MANDATORY, 0, nullptr);
  Put("events/p", H5T_NATIVE_UINT8, std::vector<std::uint8_t>{0, 1, 1, 0}, properties);
  H5Pclose(properties);
  Close();
  H5Zunregister(32008);
  ExpectError("events/p", "hdf5-filter-plugin");
}

constexpr Utime kDate = 1'600'000'000'000'000;

// More events than a probe of the units needs, 25 us apart.
TEST_F(ForeignEventFileTest, UnitsOfAnyNumberAreTold) {
  constexpr int kEvents = 40;
  std::vector<std::uint16_t> pixel(kEvents, 3);
  std::vector<Utime> expected, dated;
  for (int k = 0; k < kEvents; ++k) {
    expected.push_back(100 + 25 * k);
    dated.push_back(kDate + expected.back());
  }
  const auto read = [&](hid_t type, double scale, Utime begin) {
    SetUp();
    Put("events/x", H5T_NATIVE_UINT16, pixel);
    Put("events/y", H5T_NATIVE_UINT16, pixel);
    Put("events/p", H5T_NATIVE_UINT8, std::vector<std::uint8_t>(kEvents, 1));
    std::vector<std::int64_t> whole;
    std::vector<double> numbers;
    for (const Utime t : expected) {
      whole.push_back((t + begin) * (scale == 1000 ? 1000 : 1));
      numbers.push_back(scale * static_cast<double>(t + begin));
    }
    if (H5Tget_class(type) == H5T_INTEGER) {
      Put("events/t", type, whole);
    } else {
      Put("events/t", type, numbers);
    }
    return Read().t;
  };
  EXPECT_EQ(read(H5T_NATIVE_INT64, 1000, 0), expected);   // ns
  EXPECT_EQ(read(H5T_NATIVE_INT64, 1000, kDate), dated);  // ns, a date
  EXPECT_EQ(read(H5T_NATIVE_INT64, 1, kDate), dated);     // us
  EXPECT_EQ(read(H5T_NATIVE_DOUBLE, 1e-3, 0), expected);  // ms
  EXPECT_EQ(read(H5T_NATIVE_DOUBLE, 1e-6, 0), expected);  // s
  EXPECT_EQ(read(H5T_NATIVE_DOUBLE, 1, kDate), dated);    // us
}

TEST_F(ForeignEventFileTest, RowsAreReadInAnyOrder) {
  constexpr int kEvents = 40;
  for (const auto& order :
       std::vector<std::vector<int>>{{0, 1, 2, 3}, {1, 2, 3, 0}, {1, 2, 0, 3}, {3, 1, 2, 0}}) {
    for (const char* name : {"events", "recording/data"}) {
      Create();
      H5Ldelete(file_, "events", H5P_DEFAULT);
      std::vector<std::int64_t> table;
      for (int k = 0; k < kEvents; ++k) {
        const std::int64_t event[] = {7 + 25 * k, 200 + k % 3, 100 - k % 5, k % 2};
        for (const int which : order) table.push_back(event[which]);
      }
      const hsize_t shape[] = {kEvents, 4};
      const hid_t links = H5Pcreate(H5P_LINK_CREATE), space = H5Screate_simple(2, shape, nullptr);
      H5Pset_create_intermediate_group(links, 1);
      const hid_t set = H5Dcreate2(file_, name, H5T_NATIVE_INT64, space, links, H5P_DEFAULT, H5P_DEFAULT);
      H5Dwrite(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.data());
      H5Dclose(set), H5Sclose(space), H5Pclose(links);
      const EventArray events = Read();
      ASSERT_EQ(events.size(), std::size_t{kEvents});
      EXPECT_EQ(events.t[3], 7 + 75);
      EXPECT_EQ(events.x[1], 201);
      EXPECT_EQ(events.y[4], 96);
      EXPECT_EQ(events.p[1], 1);
    }
  }
}

}  // namespace
}  // namespace evit::formats
