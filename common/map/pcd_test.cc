#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "common/map/map_formats.h"
#include "tests/helpers/map_files.h"

namespace evit {
namespace {

using test::Load;
using test::LoadError;
using test::Raw;
using ::testing::HasSubstr;

// A greedy LZF compressor, for the tests: longest match by search.
std::string CompressLzf(const std::string& in) {
  std::string out, literals;
  const auto flush = [&] {
    for (std::size_t k = 0; k < literals.size(); k += 32) {
      const std::string run = literals.substr(k, 32);
      out += static_cast<char>(run.size() - 1);
      out += run;
    }
    literals.clear();
  };
  for (std::size_t at = 0; at < in.size();) {
    std::size_t best = 0, from = 0;
    for (std::size_t back = 1; back <= std::min<std::size_t>(at, 8192); ++back) {
      std::size_t length = 0;
      while (length < 264 && at + length < in.size() && in[at + length] == in[at + length - back]) ++length;
      if (length > best) best = length, from = back;
    }
    if (best < 3) {
      literals += in[at++];
      continue;
    }
    flush();
    const std::size_t code = best - 2, offset = from - 1;
    out += static_cast<char>((std::min<std::size_t>(code, 7) << 5) | (offset >> 8));
    if (code >= 7) out += static_cast<char>(code - 7);
    out += static_cast<char>(offset & 0xff);
    at += best;
  }
  flush();
  return out;
}

bool Decompress(const std::string& in, std::size_t size, std::string* out) {
  out->assign(size, '?');
  return DecompressLzf(reinterpret_cast<const std::uint8_t*>(in.data()), in.size(),
                       reinterpret_cast<std::uint8_t*>(out->data()), size);
}

TEST(LzfTest, LiteralsAndReferencesAreUnpacked) {
  std::string out;
  // Three literals.
  EXPECT_TRUE(Decompress(std::string("\x02", 1) + "abc", 3, &out));
  EXPECT_EQ(out, "abc");
  // One literal, then 5 bytes from one back: overlaps itself. Control 3 << 5 (length 3 + 2), offset 0.
  EXPECT_TRUE(Decompress(std::string("\x00"
                                     "a"
                                     "\x60\x00",
                                     4),
                         6, &out));
  EXPECT_EQ(out, "aaaaaa");
  // Long form: 7 << 5, then length - 9 = 4: 13 bytes from two back (offset 1).
  EXPECT_TRUE(Decompress(std::string("\x01"
                                     "xy"
                                     "\xe0\x04\x01",
                                     6),
                         15, &out));
  EXPECT_EQ(out, "xyxyxyxyxyxyxyx");
}

TEST(LzfTest, DamagedDataIsRefused) {
  std::string out;
  EXPECT_FALSE(Decompress(std::string("\x05"
                                      "abc",
                                      4),
                          6, &out));  // literals cut off
  EXPECT_FALSE(Decompress(std::string("\x02"
                                      "abc",
                                      4),
                          2, &out));  // more than announced
  EXPECT_FALSE(Decompress(std::string("\x02"
                                      "abc",
                                      4),
                          4, &out));  // less than announced
  EXPECT_FALSE(Decompress(std::string("\x00"
                                      "a"
                                      "\x60\x01",
                                      4),
                          6, &out));  // from before the start
  EXPECT_FALSE(Decompress(std::string("\x00"
                                      "a"
                                      "\x60",
                                      3),
                          6, &out));  // offset cut off
  EXPECT_FALSE(Decompress(std::string("\x00"
                                      "a"
                                      "\xe0",
                                      3),
                          6, &out));  // length cut off
  EXPECT_FALSE(Decompress(std::string("\x00"
                                      "a"
                                      "\x60\x00",
                                      4),
                          5, &out));  // runs over the end
}

TEST(LzfTest, ComesBackFromCompressionAndSurvivesRubbish) {
  std::mt19937 random(3);
  for (const int values : {2, 5, 256}) {
    std::string data;
    for (int k = 0; k < 20'000; ++k) data += static_cast<char>(random() % values);
    data += std::string(3000, 'z') + data.substr(0, 500);
    std::string packed = CompressLzf(data), out;
    ASSERT_TRUE(Decompress(packed, data.size(), &out));
    EXPECT_EQ(out, data);
    for (int k = 0; k < 300; ++k) {  // must not read or write outside: for the address sanitizer
      packed[random() % packed.size()] = static_cast<char>(random());
      Decompress(packed, data.size(), &out);
    }
  }
}

std::string Header(const std::string& fields, const std::string& sizes, const std::string& types,
                   const std::string& counts, std::size_t n, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes +
         "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + std::to_string(n) +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(n) + "\nDATA " + data + "\n";
}

const std::vector<Eigen::Vector3f> kPoints = {{1.5F, -2, 3}, {0.25F, 1e-3F, -7}, {4, 5, 6.125F}};

// Rows with another order than x y z, a double, an array and a normal in between.
const char* const kFields = "intensity z hist x y";
const char* const kSizes = "1 8 2 4 4";
const char* const kTypes = "U F U F F";
const char* const kCounts = "1 1 3 1 1";
std::vector<std::string> Columns(const Eigen::Vector3f& p) {
  return {Raw<std::uint8_t>(7), Raw<double>(p.z()), std::string(6, 'h'), Raw(p.x()), Raw(p.y())};
}

TEST(PcdTest, AsciiWithOtherFields) {
  const std::string head = Header("rgb y x normal z", "4 4 4 4 8", "F F F F F", "1 1 1 3 1", 3, "ascii");
  const LoadedMap loaded =
      Load(head + "4.2e6 -2 1.5 0 0 1 3\r\n\n4.2e6 0.001 0.25 0 0 1 -7\n9 5 4 nan nan nan 6.125");
  EXPECT_EQ(loaded.map.points, kPoints);
  EXPECT_EQ(loaded.format, "PCD ascii");
}

TEST(PcdTest, BinaryWithOtherFields) {
  std::string bytes = Header(kFields, kSizes, kTypes, kCounts, 3, "binary");
  for (const auto& p : kPoints) {
    for (const std::string& column : Columns(p)) bytes += column;
  }
  const LoadedMap loaded = Load(bytes);
  EXPECT_EQ(loaded.map.points, kPoints);
  EXPECT_EQ(loaded.format, "PCD binary");
  EXPECT_THAT(LoadError(bytes.substr(0, bytes.size() - 1)), HasSubstr("truncated"));
}

std::string Compressed(const std::vector<Eigen::Vector3f>& points) {
  std::string body;
  for (std::size_t field = 0; field < 5; ++field) {
    for (const auto& p : points) body += Columns(p)[field];
  }
  const std::string packed = CompressLzf(body);
  return Header(kFields, kSizes, kTypes, kCounts, points.size(), "binary_compressed") +
         Raw(static_cast<std::uint32_t>(packed.size())) + Raw(static_cast<std::uint32_t>(body.size())) +
         packed;
}

TEST(PcdTest, CompressedWithOtherFields) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(2000);
  for (int k = 0; k < 2000; ++k) {
    points.emplace_back(0.5F * static_cast<float>(k % 7), static_cast<float>(k),
                        -1.0F / static_cast<float>(k + 1));
  }
  const std::string bytes = Compressed(points);
  const LoadedMap loaded = Load(bytes);
  EXPECT_EQ(loaded.map.points, points);
  EXPECT_EQ(loaded.format, "PCD binary_compressed");

  EXPECT_THAT(LoadError(bytes.substr(0, bytes.size() - 1)), HasSubstr("truncated"));
  const std::size_t sizes = bytes.find("binary_compressed\n") + 18;
  EXPECT_THAT(LoadError(bytes.substr(0, sizes + 3)), HasSubstr("truncated"));
  std::string forged = bytes;
  forged.replace(sizes + 4, 4, Raw(std::uint32_t{0xffffffff}));
  EXPECT_THAT(LoadError(forged), HasSubstr("does not agree"));
  std::string damaged = bytes;
  damaged[sizes + 8] = '\xff';
  EXPECT_THAT(LoadError(damaged), HasSubstr("damaged"));
}

TEST(PcdTest, OrganisedCloudLosesItsHoles) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  std::string bytes = Header("x y z", "4 4 4", "F F F", "1 1 1", 4, "binary");
  for (const Eigen::Vector3f& p :
       {Eigen::Vector3f(nan, nan, nan), kPoints[0], Eigen::Vector3f(1, inf, 1), kPoints[1]}) {
    bytes += Raw(p.x()) + Raw(p.y()) + Raw(p.z());
  }
  const LoadedMap loaded = Load(bytes);
  EXPECT_THAT(loaded.map.points, ::testing::ElementsAre(kPoints[0], kPoints[1]));
  EXPECT_EQ(loaded.n_dropped, 2u);
}

TEST(PcdTest, PointsAreMovedByTheViewpoint) {
  std::string bytes = Header("x y z", "4 4 4", "F F F", "1 1 1", 1, "ascii") + "1 2 3\n";
  const std::string none = "VIEWPOINT 0 0 0 1 0 0 0";
  bytes.replace(bytes.find(none), none.size(),
                "VIEWPOINT 10 20 30 0.70710678 0 0 0.70710678");  // a quarter turn about z
  const LoadedMap loaded = Load(bytes);
  ASSERT_EQ(loaded.map.points.size(), 1u);
  EXPECT_LT((loaded.map.points[0] - Eigen::Vector3f(8, 21, 33)).norm(), 1e-5);
  EXPECT_THAT(loaded.format, HasSubstr("VIEWPOINT"));
  EXPECT_THAT(LoadError("FIELDS x y z\nVIEWPOINT 0 0 0 0 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n"),
              HasSubstr("VIEWPOINT: the quaternion"));
}

TEST(PcdTest, OldAndOddHeaders) {
  const auto two = ::testing::ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(4, 5, -6));
  const std::string rows = "1 2 3\n4 5 -6\n";
  for (const char* head : {"# .PCD v.5\nVERSION .5\nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\n",
                           "FIELDS x y z\nWIDTH 2\nHEIGHT 1\n",            // v.6: no POINTS
                           "FIELDS x y z\nWIDTH 1\nHEIGHT 2\n",            // organised
                           "FIELDS X Y Z\nWIDTH 1\nHEIGHT 1\nPOINTS 2\n",  // the data agrees with POINTS
                           "FIELDS x y z\nWIDTH 2\nHEIGHT 1\nPOINTS 1\n",  // with WIDTH
                           "FIELDS x y z\nWIDTH 18446744073709551615\nHEIGHT 9\nPOINTS 2\n"}) {
    EXPECT_THAT(Load(std::string(head) + "DATA ascii\n" + rows).map.points, two) << head;
  }
  std::string binary;
  for (const float v : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, -6.0F}) binary += Raw(v);
  EXPECT_THAT(Load("FIELDS x y z\r\nWIDTH 1\r\nHEIGHT 1\r\nPOINTS 2\r\nDATA binary\r\n" + binary).map.points,
              two);
  EXPECT_THAT(LoadError("FIELDS x y z\nWIDTH 5\nHEIGHT 1\nPOINTS 4\nDATA ascii\n" + rows),
              HasSubstr("POINTS is 4, WIDTH x HEIGHT 5, and the data has 2 points"));
  EXPECT_THAT(LoadError("FIELDS x y z\nPOINTS 1\nDATA ascii\n" + rows),
              HasSubstr("1 points announced, 2 found"));
  EXPECT_THAT(LoadError("FIELDS x y z\nDATA ascii\n" + rows), HasSubstr("neither POINTS nor WIDTH"));
  EXPECT_THAT(LoadError("FIELDS x y z\nPOINTS 1\nDATA ascii\n0,31 0,29 0,23\n"), HasSubstr("decimal commas"));
  const std::string cr = "# .PCD v0.7\rFIELDS x y z\rPOINTS 2\rDATA ascii\r1 2 3\r4 5 -6\r";
  EXPECT_THAT(Load(cr).map.points, two);
}

TEST(PcdTest, IntegerCoordinates) {
  const auto point = ::testing::ElementsAre(Eigen::Vector3f(-100, 200, 60'000));
  EXPECT_THAT(Load(Header("x y z", "4 2 2", "I I U", "1 1 1", 1, "binary") + Raw(std::int32_t{-100}) +
                   Raw(std::int16_t{200}) + Raw(std::uint16_t{60'000}))
                  .map.points,
              point);
  EXPECT_THAT(Load(Header("x y z", "1 8 8", "I I U", "1 1 1", 1, "binary") + Raw(std::int8_t{-100}) +
                   Raw(std::int64_t{200}) + Raw(std::uint64_t{60'000}))
                  .map.points,
              point);
}

TEST(PcdTest, ABrokenHeaderIsRefusedByItsFault) {
  const auto error = [](const std::string& fields, const std::string& sizes, const std::string& types,
                        const std::string& counts, std::size_t n, const std::string& data) {
    return LoadError(Header(fields, sizes, types, counts, n, data) + std::string(100, '1'));
  };
  EXPECT_THAT(error("x y", "4 4", "F F", "1 1", 1, "binary"), HasSubstr("FIELDS has no z"));
  EXPECT_THAT(error("x y z", "4 4", "F F F", "1 1 1", 1, "binary"), HasSubstr("SIZE has fewer"));
  EXPECT_THAT(error("x y z", "4 4 4", "F X F", "1 1 1", 1, "binary"), HasSubstr("field y: TYPE X of SIZE 4"));
  EXPECT_THAT(error("x y z", "4 4 4", "F F F", "1 1 0", 8, "binary"), HasSubstr("field z has a COUNT"));
  EXPECT_THAT(error("x y z", "4 4 4", "F F F", "1 1 1", 9, "binary"), HasSubstr("truncated"));
  EXPECT_THAT(error("x y z", "4 4 4", "F F F", "1 1 1", 4'000'000'000, "binary"), HasSubstr("truncated"));
  EXPECT_THAT(error("x y z", "4 4 4", "F F F", "1 1 1", 4'000'000'000, "ascii"), HasSubstr("cut off"));
  EXPECT_THAT(error("x y z", "4 4 4", "F F F", "1 1 1", std::size_t{1} << 60, "binary"), HasSubstr("absurd"));
  EXPECT_THAT(error("x y z w", "4 4 4 8", "F F F F", "1 1 1 99999", 1, "binary"), HasSubstr("absurd"));
  EXPECT_THAT(error("x y z", "4 4 4", "F F F", "1 1 1", 1, "lzma"), HasSubstr("\"lzma\" is not known"));
  EXPECT_THAT(error("x y z", "4 4 4", "F F F", "1 1 1", 0, "binary"), HasSubstr("the map is empty"));
  EXPECT_THAT(LoadError("# .PCD v0.7\nFIELDS x y z\nPOINTS 3\n"), HasSubstr("no DATA line"));
}

TEST(PcdTest, ABrokenTextRowIsRefusedByItsFault) {
  const std::string head = Header("x y z", "4 4 4", "F F F", "1 1 1", 2, "ascii");
  EXPECT_THAT(LoadError(head + "1 2 3\n"), HasSubstr("2 points announced, 1 found"));
  EXPECT_THAT(LoadError(head + "1 2 3\n4 5\n"), HasSubstr("ends too early"));
  EXPECT_THAT(LoadError(head + "1 2 3\n4 five 6\n"), HasSubstr("\"five\" is not a number"));
}

}  // namespace
}  // namespace evit
