#include "tools/formats/numpy/npy_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(NpyRecording, WhatItIsNotIsSaid) {
  const TemporaryFolder folder("numpy");
  const std::string rows = Rows<double, double, double>("txyp", 1e-6);
  const struct {
    std::string file, why;
  } cases[] = {
      {Npy("'<f8'", "(20, 4)", rows.substr(0, 100)), "fewer rows"},
      {Npy("'<f8'", "(20, 4)", rows, "True"), "ascontiguousarray"},
      {Npy("'>f8'", "(20, 4)", rows), "little-endian"},
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
