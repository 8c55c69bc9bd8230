#include "tools/formats/hdf5/h5_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/all_events.h"
#include "tests/helpers/ecf_encoder.h"
#include "tests/helpers/h5_files.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using Integers = std::vector<std::int64_t>;
using Doubles = std::vector<double>;

const std::vector<H5Event> kThree = {{0, 479, 1, 10}, {639, 0, 0, 11}, {2, 3, 1, 12}};

void PutColumns(H5Maker* file, const std::string& group, hid_t t_type, const Integers& t, hid_t p_type,
                const Integers& p) {
  file->Put(group + "x", H5T_STD_U16LE, Integers{0, 639, 2});
  file->Put(group + "y", H5T_STD_U16LE, Integers{479, 0, 3});
  file->Put(group + "t", t_type, t);
  file->Put(group + "p", p_type, p);
}

class H5RecordingTest : public ::testing::Test {
 protected:
  void ExpectEvents(const std::vector<std::string>& paths, const std::vector<Utime>& t,
                    const std::string& group = "") const {
    H5Recording recording(paths, group);
    const EventArray e = AllEvents(&recording, 640, 480);
    EXPECT_EQ(e.t, t);
    EXPECT_EQ(e.x, (std::vector<std::uint16_t>{0, 639, 2}));
    EXPECT_EQ(e.y, (std::vector<std::uint16_t>{479, 0, 3}));
    EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 1}));
  }
  void ExpectRefused(const std::string& why) const {
    EXPECT_THAT(
        [&] {
          H5Recording recording({path_}, "");
          AllEvents(&recording, 640, 480);
        },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path_), HasSubstr(why))));
  }

  const TemporaryFolder folder_{"h5_recording"};
  const std::string path_ = folder_.File("a.h5");
};

TEST_F(H5RecordingTest, ColumnsOfDsecAndOfTumVieWithoutOffset) {
  for (const bool offset : {true, false}) {
    {
      H5Maker file(path_);
      PutColumns(&file, "events/", H5T_STD_U32LE, {0, 5, 9}, H5T_STD_U8LE, {1, 0, 1});
      if (offset) file.Put("t_offset", H5T_STD_I64LE, Integers{1'600'000'000'000'000});
    }
    const Utime begin = offset ? 1'600'000'000'000'000 : 0;
    ExpectEvents({path_}, {begin, begin + 5, begin + 9});
  }
}

TEST_F(H5RecordingTest, ColumnsAtTheRootWithSignedPolarity) {
  {
    H5Maker file(path_);
    PutColumns(&file, "", H5T_STD_I64LE, {1'000'000, 1'000'001, 1'000'002}, H5T_STD_I8LE, {1, -1, 1});
  }
  ExpectEvents({path_}, {1'000'000, 1'000'001, 1'000'002});
}

TEST_F(H5RecordingTest, PolarityOfMinusOneStoredWithoutSign) {
  {
    H5Maker file(path_);
    PutColumns(&file, "events/", H5T_STD_I64LE, {1, 2, 3}, H5T_STD_U8LE, {1, 255, 1});
  }
  ExpectEvents({path_}, {1, 2, 3});
}

TEST_F(H5RecordingTest, SecondsAsFloats) {
  {
    H5Maker file(path_);
    PutColumns(&file, "events/", H5T_STD_I64LE, {0, 0, 0}, H5T_STD_U8LE, {1, 0, 1});
    file.Put("other/x", H5T_STD_U16LE, Integers{0});
  }
  {
    H5Maker file(path_);
    file.Put("events/x", H5T_IEEE_F32LE, Integers{0, 639, 2});
    file.Put("events/y", H5T_STD_I32LE, Integers{479, 0, 3});
    file.Put("events/p", H5T_STD_U8LE, Integers{1, 0, 1});
    file.Put("events/t", H5T_IEEE_F64LE, Doubles{1.5e9 + 0.25, 1.5e9 + 0.250001, 1.5e9 + 0.5});
  }
  ExpectEvents({path_}, {1'500'000'000'250'000, 1'500'000'000'250'001, 1'500'000'000'500'000});
}

TEST_F(H5RecordingTest, WhatHasNoSingleMeaningIsRefusedByName) {
  const auto make = [&](const Integers& p, hid_t p_type, const Doubles& x, hid_t t_type, const Doubles& t) {
    H5Maker file(path_);
    file.Put("events/x", H5T_IEEE_F64LE, x);
    file.Put("events/y", H5T_STD_U16LE, Integers{479, 0, 3});
    file.Put("events/p", p_type, p);
    file.Put("events/t", t_type, t);
  };
  make({1, 2, 1}, H5T_STD_U8LE, {0, 1, 2}, H5T_STD_I64LE, {1, 2, 3});
  ExpectRefused("the polarity is 2; expected 0 and 1, or -1 and 1");
  make({1, 0, -1}, H5T_STD_I8LE, {0, 1, 2}, H5T_STD_I64LE, {1, 2, 3});
  ExpectRefused("0 and -1 both occur");
  make({1, 0, 1}, H5T_STD_U8LE, {0, 1.5, 2}, H5T_STD_I64LE, {1, 2, 3});
  ExpectRefused("is not a whole number");
  make({1, 0, 1}, H5T_STD_U8LE, {0, 1, 2}, H5T_IEEE_F32LE, {0.5, 1, 20});
  ExpectRefused("32-bit floats");
}

TEST_F(H5RecordingTest, M3edsEventsImuAndTruth) {
  const std::string truth = folder_.File("pose_gt.h5");
  {
    H5Maker file(path_);
    for (const std::string side : {"left", "right"})
      PutColumns(&file, "prophesee/" + side + "/", H5T_STD_I64LE,
                 side == "left" ? Integers{10, 20, 30} : Integers{7, 8, 9}, H5T_STD_U8LE, {1, 0, 1});
    file.Put("prophesee/left/calib/resolution", H5T_STD_I64LE, Integers{1280, 720});
    file.Put("ovc/imu/accel", H5T_IEEE_F64LE, Doubles{0, 0, 9.81, 0, 1, 9.81}, 3);
    file.Put("ovc/imu/omega", H5T_IEEE_F64LE, Doubles{1, 2, 3, 4, 5, 6}, 3);
    file.Put("ovc/imu/ts", H5T_STD_I64LE, Integers{0, 5000});
    H5Maker gt(truth);
    gt.Put("Cn_T_C0", H5T_IEEE_F64LE, Doubles{1, 0, 0, -1, 0, 1, 0, -2, 0, 0, 1, -3, 0, 0, 0, 1}, 16);
    gt.Put("ts", H5T_STD_I64LE, Integers{100});
  }
  ExpectEvents({path_}, {10, 20, 30});
  ExpectEvents({path_, truth}, {7, 8, 9}, "/prophesee/right");
  H5Recording recording({path_, truth}, "");
  EXPECT_EQ(recording.info().width, 1280);
  EXPECT_EQ(recording.info().height, 720);
  const ImportStreams streams = recording.Streams();
  ASSERT_EQ(streams.imu.size(), 2U);
  EXPECT_EQ(streams.imu[1].t, 5000);
  EXPECT_EQ(streams.imu[1].gyro, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(streams.imu[1].accel, Eigen::Vector3d(0, 1, 9.81));
  ASSERT_EQ(streams.truth.size(), 1U);
  EXPECT_TRUE(streams.truth[0].pose.p.isApprox(Eigen::Vector3d(1, 2, 3)));
}

TEST_F(H5RecordingTest, MvsecsRowsImuAndTruth) {
  {
    H5Maker file(path_);
    file.Put("davis/left/events", H5T_IEEE_F64LE,
             Doubles{0, 479, 1.5e9, 1, 639, 0, 1.5e9 + 0.000005, -1, 2, 3, 1.5e9 + 1, 1}, 4);
    file.Put("davis/left/imu", H5T_IEEE_F64LE, Doubles{0, 0, 9.81, 1, 2, 3}, 6);
    file.Put("davis/left/imu_ts", H5T_IEEE_F64LE, Doubles{1.5e9 + 0.25});
    file.Put("davis/left/pose", H5T_IEEE_F64LE, Doubles{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1}, 16);
    file.Put("davis/left/pose_ts", H5T_IEEE_F64LE, Doubles{1.5e9 + 0.5});
  }
  constexpr Utime kBegin = 1'500'000'000'000'000;
  ExpectEvents({path_}, {kBegin, kBegin + 5, kBegin + 1'000'000});
  const ImportStreams streams = H5Recording({path_}, "").Streams();
  ASSERT_EQ(streams.imu.size(), 1U);
  EXPECT_EQ(streams.imu[0].t, kBegin + 250'000);
  EXPECT_EQ(streams.imu[0].accel, Eigen::Vector3d(0, 0, 9.81));
  EXPECT_EQ(streams.imu[0].gyro, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(streams.truth.size(), 1U);
  EXPECT_EQ(streams.truth[0].t, kBegin + 500'000);
  EXPECT_EQ(streams.truth[0].pose.p, Eigen::Vector3d(5, 6, 7));
}

// As the vendor's library writes it: events of 16 bytes, packed by ECF or not; triggers beside them; text.
void PutPropheseesFile(const std::string& path, int filter, const std::string& chunk) {
  H5Maker file(path);
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(H5Event)), trigger = H5Tcreate(H5T_COMPOUND, 24);
  H5Tinsert(type, "x", HOFFSET(H5Event, x), H5T_NATIVE_UINT16);
  H5Tinsert(type, "y", HOFFSET(H5Event, y), H5T_NATIVE_UINT16);
  H5Tinsert(type, "p", HOFFSET(H5Event, p), H5T_NATIVE_INT16);
  H5Tinsert(type, "t", HOFFSET(H5Event, t), H5T_NATIVE_INT64);
  H5Tinsert(trigger, "p", 0, H5T_NATIVE_INT16);
  H5Tinsert(trigger, "t", 8, H5T_NATIVE_INT64);
  H5Tinsert(trigger, "id", 16, H5T_NATIVE_INT16);
  file.Put("CD/events", type, type, kThree.data(), {3}, filter, chunk);
  file.Put("EXT_TRIGGER/events", trigger, trigger, std::string(24, '\0').data(), {1});
  const hid_t text = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(text, 8);
  const hid_t attribute = H5Acreate2(file.file(), "geometry", text, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, text, "1280x720");
  H5Aclose(attribute), H5Sclose(space), H5Tclose(text), H5Tclose(type), H5Tclose(trigger);
}

TEST_F(H5RecordingTest, PropheseesCompounds) {
  PutPropheseesFile(path_, 0, "");
  ExpectEvents({path_}, {10, 11, 12});
  EXPECT_EQ(H5Recording({path_}, "").info().width, 1280);
}

TEST_F(H5RecordingTest, PropheseesCompoundsInEcf) {
  using Way = EcfEncoder::Way;
  for (const Way way : {Way::kMasks, Way::kColumnsPacked, Way::kAllPacked}) {
    const std::string chunk = EcfEncoder::Encode(kThree, way);
    PutPropheseesFile(path_, 0x8ECF, chunk);
    ExpectEvents({path_}, {10, 11, 12});
    PutPropheseesFile(path_, 0x8ECF, chunk.substr(0, chunk.size() - 1));
    ExpectRefused("damaged");
    PutPropheseesFile(path_, 0x8ECF, EcfEncoder::Encode({kThree[0], kThree[1]}, way));  // HDF5 would read on
    ExpectRefused("damaged");
  }
}

// Structured arrays of numpy, as h5py writes them.
TEST_F(H5RecordingTest, CompoundsOfAnyNameAndType) {
  struct Event {
    double timestamp;
    std::int32_t x, y;
    std::int8_t polarity;
  };
  {
    H5Maker file(path_);
    const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Event));
    H5Tinsert(type, "timestamp", HOFFSET(Event, timestamp), H5T_NATIVE_DOUBLE);
    H5Tinsert(type, "x", HOFFSET(Event, x), H5T_NATIVE_INT32);
    H5Tinsert(type, "y", HOFFSET(Event, y), H5T_NATIVE_INT32);
    H5Tinsert(type, "polarity", HOFFSET(Event, polarity), H5T_NATIVE_INT8);
    const std::vector<Event> events = {
        {1.5e9 + 0.25, 0, 479, 1}, {1.5e9 + 0.250001, 639, 0, -1}, {1.5e9 + 0.5, 2, 3, 1}};
    file.Put("recording/data", type, type, events.data(), {3});
    H5Tclose(type);
  }
  ExpectEvents({path_}, {1'500'000'000'250'000, 1'500'000'000'250'001, 1'500'000'000'500'000});
}

TEST_F(H5RecordingTest, AFileWithoutEventsListsWhatItHas) {
  {
    H5Maker file(path_);
    file.Put("rectify_map", H5T_IEEE_F64LE, Doubles{1, 2});
  }
  EXPECT_THAT(
      [&] { H5Recording({path_}, ""); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("holds no events"), HasSubstr("rectify_map"))));
}

// MATLAB's files of version 7.3: an N x 4 matrix is 4 x N, a column 1 x N.
TEST_F(H5RecordingTest, WhatStandsAcrossIsRead) {
  constexpr hsize_t kEvents = 40;
  Doubles t, x, y, p;
  for (int k = 0; k < static_cast<int>(kEvents); ++k)
    t.push_back(7 + 25 * k), x.push_back(k % 3), y.push_back(100 + k % 5), p.push_back(k % 2);
  const auto expect = [&] {
    H5Recording recording({path_}, "");
    const EventArray e = AllEvents(&recording, 640, 480);
    ASSERT_EQ(e.size(), kEvents);
    for (std::size_t k = 0; k < kEvents; ++k) {
      EXPECT_EQ(static_cast<double>(e.t[k]), t[k]);
      EXPECT_EQ(e.x[k], x[k]);
      EXPECT_EQ(e.y[k], y[k]);
      EXPECT_EQ(e.p[k], p[k]);
    }
  };
  {
    H5Maker file(path_);
    Doubles all;
    for (const Doubles* row : {&t, &x, &y, &p}) all.insert(all.end(), row->begin(), row->end());
    file.Put("events", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, all.data(), {4, kEvents});
  }
  expect();
  {
    H5Maker file(path_);
    for (const auto& [name, row] :
         {std::pair("t", &t), std::pair("x", &x), std::pair("y", &y), std::pair("p", &p)})
      file.Put(std::string("data/") + name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, row->data(), {1, kEvents});
  }
  expect();
}

TEST_F(H5RecordingTest, WhatWasNeverStoredIsRefused) {
  const hid_t file = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
              how = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t shape = hsize_t{1} << 40, chunk = 1000;
  H5Pset_chunk(how, 1, &chunk);
  const hid_t space = H5Screate_simple(1, &shape, nullptr);
  for (const char* name : {"x", "y", "t", "p"})
    H5Dclose(H5Dcreate2(file, name, H5T_STD_U32LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
  H5Sclose(space), H5Pclose(how), H5Fclose(file);
  ExpectRefused("stores only 0 bytes");
}

}  // namespace
}  // namespace evit::formats
