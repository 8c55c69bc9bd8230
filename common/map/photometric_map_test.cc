#include "common/map/photometric_map.h"

#include <gmock/gmock.h>

#include "tests/helpers/map_files.h"

namespace evit {
namespace {

using ::testing::HasSubstr;

std::string Error(const std::string& bytes) {
  const test::TemporaryFile file(bytes, "photometric.ply");
  try {
    LoadPhotometricMap(file.path());
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(file.path() + ": ", 0), 0u) << error.what();
    return error.what();
  }
  return "";
}

std::string Ascii(const std::string& properties, const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex 2\n" + properties + "end_header\n" + rows;
}
constexpr char kXyz[] = "property float x\nproperty float y\nproperty float z\n";

TEST(PhotometricMap, ComesBackAsWritten) {
  PhotometricMap map;
  for (int k = 0; k < 1000; ++k) {
    map.points.emplace_back(0.1F * static_cast<float>(k), -2, 1e-3F * static_cast<float>(k));
    map.intensities.push_back(static_cast<float>(k) / 1000);
  }
  const test::TemporaryFile file("", "round_trip.ply");
  WritePhotometricMap(file.path(), map);
  const PhotometricMap back = LoadPhotometricMap(file.path());
  EXPECT_EQ(back.points, map.points);
  EXPECT_EQ(back.intensities, map.intensities);
  EXPECT_EQ(LoadMap(file.path()).map.points, map.points);  // a point cloud like any other
  EXPECT_THROW(WritePhotometricMap("/nowhere/map.ply", map), std::runtime_error);
}

TEST(PhotometricMap, LeavesOutWhatIsNotFinite) {
  const std::string rows = "1 2 3 0.5\nnan 0 0 0.1\n";
  const test::TemporaryFile file(Ascii(kXyz + std::string("property float intensity\n"), rows), "nan.ply");
  const PhotometricMap map = LoadPhotometricMap(file.path());
  ASSERT_EQ(map.points.size(), 1u);
  EXPECT_EQ(map.points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(map.intensities[0], 0.5F);
}

TEST(PhotometricMap, BadFilesAreNamedWithTheRemedy) {
  const std::string with = kXyz + std::string("property float intensity\n");
  EXPECT_THAT(Error(""), HasSubstr("cannot be read, or is empty"));
  EXPECT_THAT(Error("1 2 3 0.5\n"), HasSubstr("evit map photometric"));
  EXPECT_THAT(Error(Ascii(kXyz, "1 2 3\n4 5 6\n")), HasSubstr("no property intensity"));
  EXPECT_THAT(Error(Ascii(with, "1 2 3 0.5\n4 5 6 200\n")), HasSubstr("vertex 1: intensity is not 0..1"));
  EXPECT_THAT(Error(Ascii(with, "1 2 3 nan\n4 5 nan 1\n")), HasSubstr("the map is empty"));
  EXPECT_THAT(Error(Ascii(with, "1 2 3 0.5\n")), HasSubstr("truncated"));
}

}  // namespace
}  // namespace evit
