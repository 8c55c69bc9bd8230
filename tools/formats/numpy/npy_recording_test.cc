#include "tools/formats/numpy/npy_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <algorithm>
#include <fstream>

#include "tests/helpers/all_events.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

template <typename T>
void Put(T value, std::string* out) {
  out->append(reinterpret_cast<const char*>(&value), sizeof value);
}

// As numpy.save writes it.
std::string Npy(const std::string& descr, const std::string& shape, const std::string& rows,
                const std::string& fortran = "False") {
  std::string header = "{'descr': " + descr + ", 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
  header.append(64 - (10 + header.size() + 1) % 64, ' ');
  header += '\n';
  std::string file = std::string("\x93NUMPY\x01", 7) + '\0';
  Put(static_cast<std::uint16_t>(header.size()), &file);
  return file + header + rows;
}

constexpr int kEvents = 20;
constexpr Utime kBegin = 1'600'000'000'000'000;

template <typename X, typename P, typename T>
std::string Rows(const std::string& order, double unit) {
  std::string rows;
  for (int k = 0; k < kEvents; ++k) {
    for (const char c : order) {
      if (c == 't') Put(static_cast<T>(static_cast<double>(kBegin + 100 * k) * unit), &rows);
      if (c == 'x') Put(static_cast<X>(10 * k), &rows);
      if (c == 'y') Put(static_cast<X>(k), &rows);
      if (c == 'p') Put(static_cast<P>(k % 2), &rows);
    }
  }
  return rows;
}

void ExpectEvents(const std::string& path) {
  ASSERT_TRUE(NpyRecording::Recognises(path));
  NpyRecording recording(path);
  const EventArray events = AllEvents(&recording, 640, 480);
  ASSERT_EQ(events.size(), static_cast<std::size_t>(kEvents));
  for (int k = 0; k < kEvents; ++k) {
    const auto n = static_cast<std::size_t>(k);
    EXPECT_EQ(events.t[n], kBegin + 100 * k);
    EXPECT_EQ(events.x[n], 10 * k);
    EXPECT_EQ(events.y[n], k);
    EXPECT_EQ(events.p[n], k % 2);
  }
}

TEST(NpyRecording, StructuredArraysByTheNamesOfTheirFields) {
  const TemporaryFolder folder("numpy");
  ExpectEvents(folder.Write("a.npy", Npy("[('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '|u1')]", "(20,)",
                                         Rows<std::uint16_t, std::uint8_t, std::int64_t>("txyp", 1))));
  ExpectEvents(
      folder.Write("a.npy", Npy("[('x', '<i2'), ('y', '<i2'), ('polarity', '|b1'), ('timestamp', '<f8')]",
                                "(20,)", Rows<std::int16_t, bool, double>("xypt", 1e-6))));
}

TEST(NpyRecording, RowsByTheirValues) {
  const TemporaryFolder folder("numpy");
  ExpectEvents(folder.Write("a.npy", Npy("'<f8'", "(20, 4)", Rows<double, double, double>("xytp", 1e-6))));
  ExpectEvents(folder.Write(
      "a.npy", Npy("'<i8'", "(20, 4)", Rows<std::int64_t, std::int64_t, std::int64_t>("txyp", 1))));
}

template <typename T>
std::string Column(char which, bool big_endian = false) {
  std::string rows = Rows<T, T, T>(std::string(1, which), 1);
  for (std::size_t at = 0; big_endian && at < rows.size(); at += sizeof(T))
    std::reverse(rows.begin() + static_cast<std::ptrdiff_t>(at),
                 rows.begin() + static_cast<std::ptrdiff_t>(at + sizeof(T)));
  return rows;
}

TEST(NpyRecording, ColumnsThatStandOneAfterTheOther) {
  const TemporaryFolder folder("numpy");
  std::string columns, big;
  for (const char c : {'t', 'x', 'y', 'p'})
    columns += Column<std::int64_t>(c), big += Column<std::int64_t>(c, true);
  ExpectEvents(folder.Write("a.npy", Npy("'<i8'", "(20, 4)", columns, "True")));
  ExpectEvents(folder.Write("a.npy", Npy("'<i8'", "(4, 20)", columns)));
  ExpectEvents(folder.Write("a.npy", Npy("'>i8'", "(4, 20)", big)));
}

TEST(NpyRecording, PaddingDatesAndFieldsOfOtherThings) {
  const TemporaryFolder folder("numpy");
  std::string rows;
  for (int k = 0; k < kEvents; ++k) {
    Put(static_cast<std::uint16_t>(10 * k), &rows);
    Put(static_cast<std::uint16_t>(k), &rows);
    Put(static_cast<std::uint8_t>(k % 2), &rows);
    rows += "abc";
    Put(0.5, &rows), Put(0.5, &rows);
    Put(static_cast<std::int64_t>(kBegin + 100 * k), &rows);
  }
  ExpectEvents(folder.Write("a.npy", Npy("[('x', '<u2'), ('y', '<u2'), ('p', '|u1'), ('', '|V3'), "
                                         "('undistorted', '<f8', (2,)), ('t', '<M8[us]')]",
                                         "(20,)", rows)));
}

// As numpy.savez and savez_compressed write it.
std::string Npz(const TemporaryFolder& folder, const std::vector<std::pair<std::string, std::string>>& arrays,
                bool packed) {
  const std::string path = folder.File("a.npz");
  std::remove(path.c_str());
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE, nullptr);
  for (const auto& [name, array] : arrays) {
    const auto index = static_cast<zip_uint64_t>(
        zip_file_add(archive, (name + ".npy").c_str(),
                     zip_source_buffer(archive, array.data(), array.size(), 0), ZIP_FL_ENC_UTF_8));
    zip_set_file_compression(archive, index, packed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
  }
  EXPECT_EQ(zip_close(archive), 0);
  return path;
}

TEST(NpyRecording, ArchivesOfOneArrayOrOfOneForEachColumn) {
  const TemporaryFolder folder("numpy");
  const std::string t = Npy("'<i8'", "(20,)", Column<std::int64_t>('t')),
                    x = Npy("'<u2'", "(20,)", Column<std::uint16_t>('x')),
                    y = Npy("'<u2'", "(20,)", Column<std::uint16_t>('y')),
                    p = Npy("'|u1'", "(20,)", Column<std::uint8_t>('p'));
  for (const bool packed : {false, true}) {
    ExpectEvents(Npz(folder,
                     {{"p", p},
                      {"width", Npy("'<i8'", "()", std::string(8, '\1'))},
                      {"timestamps", t},
                      {"x", x},
                      {"y", y}},
                     packed));
    ExpectEvents(Npz(folder,
                     {{"imu", Npy("'<f8'", "(2, 7)", std::string(112, '\0'))},
                      {"arr_0", Npy("[('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '|u1')]", "(20,)",
                                    Rows<std::uint16_t, std::uint8_t, std::int64_t>("txyp", 1))}},
                     packed));
  }
  const std::vector<std::pair<std::string, std::string>> stereo = {
      {"left/t", t},  {"left/x", x},  {"left/y", y},  {"left/p", p},
      {"right/t", t}, {"right/x", y}, {"right/y", x}, {"right/p", p}};
  const std::string path = Npz(folder, stereo, true);
  EXPECT_THAT([&] { NpyRecording{path}; }, ThrowsMessage<std::runtime_error>(
                                               AllOf(HasSubstr("--events-topic"), HasSubstr("left, right"))));
  NpyRecording right(path, "right");
  EXPECT_EQ(AllEvents(&right, 640, 480).y[2], 20);
}

// Rows of a stamp in `unit` seconds, then three or six values that are x, y and z of gyro and accelerometer.
std::string ImuRows(bool stamp, bool gyro, bool accel) {
  std::string rows;
  for (int k = 0; k < kEvents; ++k) {
    if (stamp) Put(1.6e9 + 0.005 * k, &rows);
    if (gyro)
      for (const double v : {0.1, 0.2, 0.01 * k}) Put(v, &rows);
    if (accel)
      for (const double v : {0.5, 0.25, 9.8}) Put(v, &rows);
  }
  return rows;
}

void ExpectImu(const ImportStreams& streams, const std::string& path) {
  EXPECT_THAT(streams.imu_name, HasSubstr(path));
  ASSERT_EQ(streams.imu.size(), static_cast<std::size_t>(kEvents));
  EXPECT_EQ(streams.imu[2].t, 1'600'000'000'010'000);
  EXPECT_EQ(streams.imu[2].gyro, Eigen::Vector3d(0.1, 0.2, 0.02));
  EXPECT_EQ(streams.imu[2].accel, Eigen::Vector3d(0.5, 0.25, 9.8));
}

TEST(NpyRecording, AnImuBesideTheEventsIsRead) {
  const TemporaryFolder folder("numpy");
  const std::string f8 = "'<f8'";
  const std::pair<std::string, std::string> events{
      "events", Npy("'<f8'", "(20, 4)", Rows<double, double, double>("txyp", 1e-6))};
  const std::string stamp = Npy(f8, "(20,)", ImuRows(true, false, false)),
                    gyro = Npy(f8, "(20, 3)", ImuRows(false, true, false)),
                    accel = Npy(f8, "(20, 3)", ImuRows(false, false, true)),
                    both = Npy(f8, "(20, 6)", ImuRows(false, true, true)),
                    all = Npy(f8, "(20, 7)", ImuRows(true, true, true));
  const std::vector<std::vector<std::pair<std::string, std::string>>> archives = {
      {events, {"imu", all}},
      {events, {"accel", accel}, {"gyro", gyro}, {"imu_ts", stamp}},
      {events, {"imu/gyro", gyro}, {"imu/acc", accel}, {"imu/t", stamp}},
      {events, {"imu_linear_acceleration", accel}, {"imu_angular_velocity", gyro}, {"imu_timestamp", stamp}},
      {events, {"imu", both}, {"imu_t", stamp}}};
  for (const auto& arrays : archives) {
    const std::string path = Npz(folder, arrays, true);
    SCOPED_TRACE(arrays.back().first + ", " + arrays[1].first);
    ExpectEvents(path);
    ExpectImu(NpyRecording(path).Streams(), path);
  }
  // By itself it is an IMU, for --imu.
  const std::string alone = folder.Write("imu.npy", all);
  NpyRecording imu(alone);
  ExpectImu(imu.Streams(), alone);
  EXPECT_THAT([&] { imu.Events(640, 480); }, ThrowsMessage<std::runtime_error>(HasSubstr("holds no events")));
  // Which of two it is cannot be told.
  const std::string two = Npz(folder, {events, {"imu", all}, {"imu2", all}}, false);
  EXPECT_THAT([&] { NpyRecording{two}; },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("imu2"), HasSubstr("--imu"))));
}

TEST(NpyRecording, DamagedArchivesAreNamed) {
  const TemporaryFolder folder("numpy");
  const std::string whole =
      Npz(folder, {{"e", Npy("'<f8'", "(20, 4)", Rows<double, double, double>("txyp", 1e-6))}}, true);
  std::ifstream in(whole, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t n = 60; n < bytes.size(); n += 7) {
    const std::string path = folder.Write("cut.npz", bytes.substr(0, n));
    EXPECT_THAT([&] { NpyRecording{path}; }, ThrowsMessage<std::runtime_error>(HasSubstr(path))) << n;
  }
}

TEST(NpyRecording, WhatItIsNotIsSaid) {
  const TemporaryFolder folder("numpy");
  const std::string rows = Rows<double, double, double>("txyp", 1e-6);
  const struct {
    std::string file, why;
  } cases[] = {
      {Npy("'<f8'", "(20, 4)", rows.substr(0, 100)), "fewer rows"},
      {Npy("[('e', [('t', '<f8'), ('x', '<f8')])]", "(40,)", rows), "fields in fields"},
      {Npy("'|O'", "(20, 4)", rows), "|O"},
      {Npy("'<f8'", "(5, 4, 4)", rows), "N x 4"},
      {Npy("'<f8'", "(10, 8)", rows), "holds no events"},
      {Npy("[('a', '<f8'), ('b', '<f8')]", "(40,)", rows), "a, b"},
      {Npy("'<f8'", "(20, 4)", rows).substr(0, 30), "cut off"},
  };
  for (const auto& c : cases) {
    const std::string path = folder.Write("a.npy", c.file);
    EXPECT_THAT([&] { NpyRecording{path}; },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path), HasSubstr(c.why))));
  }
}

}  // namespace
}  // namespace evit::formats
