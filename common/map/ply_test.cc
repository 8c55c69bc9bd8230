#include <gmock/gmock.h>

#include "tests/helpers/map_files.h"

namespace evit {
namespace {

using test::Load;
using test::LoadError;
using test::Raw;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<Eigen::Vector3f> kPlyPoints = {{1.5F, -2, 3}, {0.25F, 1e-3F, -7}};

std::string Header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment by a test\n" + elements + "end_header\n";
}

// Before the vertices an element with a list; within them a colour, a double and a list.
std::string Elements(int vertices) {
  return "element camera 1\nproperty float view\nproperty list uchar short tags\nelement vertex " +
         std::to_string(vertices) +
         "\nproperty uchar red\nproperty double y\nproperty float x\nproperty list int float weights\n"
         "property float32 z\nelement face 1\nproperty list uchar int vertex_indices\n";
}

TEST(PlyTest, AsciiGivesTheVerticesAmongOtherElements) {
  const LoadedMap loaded = Load(Header("ascii", Elements(2)) +
                                "0.5 3 1 2 3\n255 -2 1.5 2 0.5 0.5 3\n0 0.001 0.25 0 -7\n3 0 1 0\n");
  EXPECT_EQ(loaded.map.points, kPlyPoints);
  EXPECT_EQ(loaded.format, "PLY ascii");
}

std::string Binary(bool big) {
  std::string bytes = Header(big ? "binary_big_endian" : "binary_little_endian", Elements(2));
  bytes += Raw(0.5F, big) + Raw<std::uint8_t>(3) + Raw<std::int16_t>(1, big) + Raw<std::int16_t>(2, big) +
           Raw<std::int16_t>(3, big);
  for (int k = 0; k < 2; ++k) {
    bytes += Raw<std::uint8_t>(255) + Raw(static_cast<double>(kPlyPoints[k].y()), big) +
             Raw(kPlyPoints[k].x(), big);
    bytes += Raw<std::int32_t>(2 * k, big);
    for (int i = 0; i < 2 * k; ++i) bytes += Raw(9.0F, big);
    bytes += Raw(kPlyPoints[k].z(), big);
  }
  return bytes;
}

TEST(PlyTest, BinaryInBothByteOrders) {
  for (const bool big : {false, true}) {
    const LoadedMap loaded = Load(Binary(big));
    EXPECT_EQ(loaded.map.points, kPlyPoints) << big;
    EXPECT_EQ(loaded.format, big ? "PLY binary_big_endian" : "PLY binary_little_endian");
    const std::string bytes = Binary(big);
    EXPECT_THAT(LoadError(bytes.substr(0, bytes.size() - 1)), HasSubstr("truncated"));
  }
}

TEST(PlyTest, HeaderWithWindowsLineEnds) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
      "property float z\r\nend_header\r\n1 2 3\r\n";
  EXPECT_THAT(Load(text).map.points, ElementsAre(Eigen::Vector3f(1, 2, 3)));
}

TEST(PlyTest, OldMacLineEndsAndUpperCase) {
  const std::string text =
      "PLY\rFORMAT ASCII 1.0\rELEMENT VERTEX 1\rPROPERTY FLOAT X\rPROPERTY FLOAT Y\r"
      "PROPERTY FLOAT Z\rEND_HEADER\r1 2 3\r";
  EXPECT_THAT(Load(text).map.points, ElementsAre(Eigen::Vector3f(1, 2, 3)));
  const std::string binary =
      "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty float X\rproperty float Y\r"
      "property float Z\rend_header\r" +
      Raw(1.0F) + Raw(2.0F) + Raw(3.0F);
  EXPECT_THAT(Load(binary).map.points, ElementsAre(Eigen::Vector3f(1, 2, 3)));
}

TEST(PlyTest, ABrokenFileIsRefusedByItsFault) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(LoadError("ply\nformat ascii 1.0\nelement vertex 1\n"), HasSubstr("no end_header"));
  EXPECT_THAT(LoadError(Header("ebcdic", "element vertex 1\n" + xyz) + "1 2 3"), HasSubstr("not known"));
  EXPECT_THAT(LoadError(Header("ascii", "element vertex 1\nproperty half x\n") + "1"), HasSubstr("\"half\""));
  EXPECT_THAT(LoadError(Header("ascii", "element face 1\n" + xyz) + "1 2 3"), HasSubstr("no vertex element"));
  EXPECT_THAT(LoadError(Header("ascii", xyz)), HasSubstr("before any element"));
  EXPECT_THAT(LoadError(Header("ascii", "element vertex\n" + xyz) + "1 2 3"),
              HasSubstr("lacks name or count"));
  EXPECT_THAT(LoadError(Header("ascii", "element vertex 1\nproperty float x\nproperty float y\n") + "1 2"),
              HasSubstr("no property z"));
  EXPECT_THAT(LoadError(Header("ascii", "element vertex 2\n" + xyz) + "1 2 3\n4 5"), HasSubstr("truncated"));
  EXPECT_THAT(LoadError(Header("ascii", "element vertex 1\n" + xyz) + "1 two 3"),
              HasSubstr("expected a number"));
  EXPECT_THAT(LoadError(Header("ascii", "element vertex 0\n" + xyz)), HasSubstr("the map is empty"));
  for (const char* count : {"4000000000000", "-1", "18446744073709551615"}) {
    EXPECT_THAT(
        LoadError(Header("binary_little_endian", std::string("element vertex ") + count + "\n" + xyz) +
                  std::string(24, '\0')),
        HasSubstr("more than the file holds"));
  }
  // A list that claims two thousand million entries.
  EXPECT_THAT(LoadError(Header("binary_little_endian",
                               "element vertex 1\n" + xyz + "property list uint uchar more\n") +
                        std::string(12, '\0') + Raw<std::uint32_t>(2'000'000'000)),
              HasSubstr("count is absurd"));
}

}  // namespace
}  // namespace evit
