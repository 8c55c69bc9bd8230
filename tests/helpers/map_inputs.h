#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/helpers/painted_pictures.h"
#include "tests/helpers/run_evit.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::test {

/// `evit map build` on pictures of a painted scene, whose edges are known.
class MapInputs : public testing::Test {
 protected:
  static void SetUpTestSuite() { painted_ = new PaintedPictures; }
  static void TearDownTestSuite() {
    delete painted_;
    painted_ = nullptr;
  }
  void SetUp() override {
    WriteCamera("camera.textproto", {});
    WriteTum(File("poses.tum"), painted_->poses);
  }

  std::string File(const std::string& name) const { return folder_.File(name); }
  void Write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories(std::filesystem::path(File(name)).parent_path());
    folder_.Write(name, bytes);
  }
  void WriteCamera(const std::string& name, const SE3& T_body_camera) const {
    MountedCamera mounted;
    mounted.camera = painted_->camera;
    mounted.T_body_camera = T_body_camera;
    WriteMountedCamera(File(name), mounted, "test");
  }
  // Poses every 10 ms, of a motion through the pictures' poses.
  Trajectory Dense(const SE3& T_camera_posed) const {
    Trajectory dense;
    for (Utime t = painted_->poses.front().t; t <= painted_->poses.back().t; t += 10'000) {
      SE3 pose;
      PoseAt(painted_->poses, t, &pose);
      dense.push_back({t, pose * T_camera_posed});
    }
    return dense;
  }
  ProgramOutcome Build(const std::string& arguments) const {
    std::filesystem::remove(File("map.pcd"));
    return RunEvit("map build --out " + File("map.pcd") + " " + arguments);
  }
  std::string Calibrated() const {
    return " --poses " + File("poses.tum") + " --camera " + File("camera.textproto");
  }
  void ExpectGoodMap(const ProgramOutcome& outcome, double median_m = 0.005) const {
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const std::vector<double> errors = painted_->Errors(File("map.pcd"));
    ASSERT_GT(errors.size(), 500U);
    EXPECT_LT(errors[errors.size() / 2], median_m);
  }
  void ExpectRefused(const ProgramOutcome& outcome, const std::string& words) const {
    EXPECT_NE(outcome.code, 0) << words;
    EXPECT_THAT(outcome.output, ::testing::HasSubstr(words));
    EXPECT_FALSE(std::filesystem::exists(File("map.pcd")) || std::filesystem::exists(File("map.pcd.part")))
        << words;
  }

  static inline PaintedPictures* painted_ = nullptr;

 private:
  TemporaryFolder folder_{"map_inputs"};
};

/// A picture's name by its stamp, as VECtor's and TUM's are.
inline std::string StampName(Utime t) {
  char name[60];
  std::snprintf(name, sizeof name, "%lld.%06lld.png", static_cast<long long>(t / 1'000'000),
                static_cast<long long>(t % 1'000'000));
  return name;
}

}  // namespace evit::test
