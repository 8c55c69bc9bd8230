// `evit map build` on pictures, poses and calibrations from which no good map can be made: the program says
// so.
#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "tests/helpers/map_inputs.h"

namespace evit::commands {
namespace {

namespace fs = std::filesystem;
using test::StampName;
using ::testing::HasSubstr;

class MapInputFaultsTest : public test::MapInputs {};

// Each depth looks right by itself: only other views tell that a pose is wrong.
TEST_F(MapInputFaultsTest, DepthWithPosesOfAnotherTimeOrWithNothingInItIsNamed) {
  Trajectory shuffled;
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
    const StampedPose& pose = painted_->poses[k];
    const cv::Mat depth = painted_->scene.Depth(painted_->camera, pose.pose, 1000);
    Write("grey/" + StampName(pose.t), PaintedPictures::Png(painted_->pictures[k]));
    Write("depth/" + StampName(pose.t), PaintedPictures::Png(depth));
    Write("empty/" + StampName(pose.t), PaintedPictures::Png(cv::Mat::zeros(depth.size(), depth.type())));
    shuffled.push_back({pose.t, painted_->poses[(7 * k + 3) % painted_->poses.size()].pose});
  }
  const std::string grey = "--images " + File("grey") + Calibrated();
  ExpectGoodMap(Build(grey + " --depth " + File("depth")));
  ExpectRefused(Build(grey + " --depth " + File("empty")),
                "pictures show edges with a depth, a map needs three");
  WriteTum(File("poses.tum"), shuffled);
  const test::ProgramOutcome wrong = Build(grey + " --depth " + File("depth"));
  EXPECT_TRUE(wrong.code != 0 || wrong.output.find("warning:") != std::string::npos) << wrong.output;
  EXPECT_THAT(wrong.output, testing::ContainsRegex("clock(, order)? (or|and) frame"));
}

// Poses of the body where the camera's are expected: the clock fits, the frame does not.
TEST_F(MapInputFaultsTest, PosesOfAnotherFrameOrClockAreNamed) {
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k)
    Write("grey/" + StampName(painted_->poses[k].t), PaintedPictures::Png(painted_->pictures[k]));
  const std::string grey = "--images " + File("grey") + Calibrated();
  Trajectory body, late;
  for (const StampedPose& pose : Dense(SE3(ExpSO3({1.2, -1.2, 1.2}), {0.1, 0, 0.05}))) body.push_back(pose);
  WriteTum(File("poses.tum"), body);
  const test::ProgramOutcome askew = Build(grey);
  EXPECT_TRUE(askew.code != 0 || askew.output.find("warning:") != std::string::npos) << askew.output;
  EXPECT_THAT(askew.output, testing::ContainsRegex("clock(, order)? (or|and) frame"));
  // Half a second late within the recording: some pictures have a pose, a wrong one.
  for (const StampedPose& pose : Dense({})) late.push_back({pose.t + 500'000, pose.pose});
  WriteTum(File("poses.tum"), late);
  const test::ProgramOutcome outcome = Build(grey);
  EXPECT_THAT(outcome.output, HasSubstr("pictures have no pose"));
  EXPECT_TRUE(outcome.code != 0 || outcome.output.find("warning:") != std::string::npos) << outcome.output;
  // Nothing but what lies between two poses far apart.
  WriteTum(File("poses.tum"), {body.front(), body.back()});
  ExpectRefused(Build(grey), "have a pose, a map needs three");
}

TEST_F(MapInputFaultsTest, BlurredDarkAndCoveredPicturesAreLeftOut) {
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
    cv::Mat picture = painted_->pictures[k].clone();
    if (k == 2) cv::GaussianBlur(picture, picture, {}, 30);
    if (k == 5) picture *= 0.002;
    if (k == 9) picture.setTo(3);
    Write("grey/" + StampName(painted_->poses[k].t), PaintedPictures::Png(picture));
  }
  const test::ProgramOutcome outcome = Build("--images " + File("grey") + Calibrated());
  ExpectGoodMap(outcome);
  EXPECT_THAT(outcome.output, HasSubstr("3 of 16 pictures show few edges (blurred, dark, covered"));
}

TEST_F(MapInputFaultsTest, NoTextureAndTooFewViewsAreNamed) {
  cv::RNG noise(1);
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
    cv::Mat wall(150, 200, CV_8U);
    noise.fill(wall, cv::RNG::NORMAL, 120, 3);
    Write("wall/" + StampName(painted_->poses[k].t), PaintedPictures::Png(wall));
    if (k < 2) Write("two/" + StampName(painted_->poses[k].t), PaintedPictures::Png(painted_->pictures[k]));
  }
  ExpectRefused(Build("--images " + File("wall") + Calibrated()), "there is no texture");
  ExpectRefused(Build("--images " + File("two") + Calibrated()), "a map needs three");
}

// Another lens: depths that agree are few, or off.
TEST_F(MapInputFaultsTest, WrongIntrinsicsAreWarnedOf) {
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k)
    Write("grey/" + StampName(painted_->poses[k].t), PaintedPictures::Png(painted_->pictures[k]));
  MountedCamera other;
  other.camera = painted_->camera;
  other.camera.fx = other.camera.fy = 220;
  other.camera.cx = 70;
  WriteMountedCamera(File("camera.textproto"), other, "test");
  const test::ProgramOutcome outcome = Build("--images " + File("grey") + Calibrated());
  EXPECT_TRUE(outcome.code != 0 || outcome.output.find("warning:") != std::string::npos) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("calibration"));
  EXPECT_THAT(outcome.output, testing::Not(HasSubstr("ms apart"))) << "each picture has a pose of its own";
  // Of another size: refused before anything is read.
  other.camera.width = 640;
  WriteMountedCamera(File("camera.textproto"), other, "test");
  ExpectRefused(Build("--images " + File("grey") + Calibrated()), "the camera file says 640x150");
}

// A full disk, a folder that may not be written: no half map.
TEST_F(MapInputFaultsTest, WhatCannotBeWrittenLeavesNothing) {
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k)
    Write("grey/" + StampName(painted_->poses[k].t), PaintedPictures::Png(painted_->pictures[k]));
  fs::create_directories(File("map.pcd.part"));
  const test::ProgramOutcome outcome = Build("--images " + File("grey") + Calibrated());
  EXPECT_NE(outcome.code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("map.pcd"));
  EXPECT_FALSE(fs::exists(File("map.pcd")));
}

}  // namespace
}  // namespace evit::commands
