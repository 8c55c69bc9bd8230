// `evit map build` on pictures as people have them, the program.
#include "tests/helpers/map_inputs.h"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>

#include "common/files/decimal_time.h"
#include "tests/helpers/ros_bags.h"
#include "tests/helpers/zip_files.h"

namespace evit::commands {
namespace {

using test::StampName;
using ::testing::HasSubstr;

class MapInputsTest : public test::MapInputs {};

// VECtor's left camera: names are stamps. One file is damaged; two lie after the poses' end.
TEST_F(MapInputsTest, AZipOfPicturesWithStampsAndPosesAtAnotherRate) {
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k)
    files.emplace_back("left_camera/" + StampName(painted_->poses[k].t),
                       PaintedPictures::Png(painted_->pictures[k]));
  files[7].second.resize(200);
  WriteZip(File("left.zip"), files);
  Trajectory dense = Dense({});
  dense.resize(dense.size() - 20);
  WriteTum(File("poses.tum"), dense);
  const test::ProgramOutcome outcome = Build("--images " + File("left.zip") + Calibrated());
  ExpectGoodMap(outcome);
  EXPECT_THAT(outcome.output, HasSubstr("2 of 16 pictures have no pose"));
  EXPECT_THAT(outcome.output, HasSubstr("1 of 14 pictures cannot be read"));
}

// VECtor's left_camera folder: begin and end of each exposure in a list beside the pictures. Its camera has
// 12 bits here, and one dark picture that would look like one of 10.
TEST_F(MapInputsTest, AFolderWithTheExposuresInAListAndSixteenBits) {
  std::string list = "# Left Regular Camera's timestamp data\n# start and end of the exposure time[s]\n";
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
    const std::string name = StampName(painted_->poses[k].t);
    const Utime end = painted_->poses[k].t + 10'000;
    list += name.substr(0, name.size() - 4) + " " + DecimalSeconds(end) + "\n";
    cv::Mat levels;
    painted_->pictures[k].convertTo(levels, CV_16U, k == 5 ? 3.9 : 16);
    Write("desk1.synced.left_camera/" + name, PaintedPictures::Png(levels));
  }
  Write("desk1.synced.left_camera/timestamp.txt", list);
  WriteTum(File("poses.tum"), Dense({}));
  ExpectGoodMap(Build("--images " + File("desk1.synced.left_camera") + Calibrated()));
}

// Written by a driver that did not fill in the colours.
TEST_F(MapInputsTest, MosaicsOfAColourSensor) {
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
    cv::Mat mosaic = painted_->pictures[k].clone();
    for (int row = 0; row < mosaic.rows; ++row) {
      for (int column = row % 2; column < mosaic.cols; column += 2) mosaic.at<std::uint8_t>(row, column) /= 2;
    }
    Write("bayer/" + StampName(painted_->poses[k].t), PaintedPictures::Png(mosaic));
  }
  const test::ProgramOutcome outcome = Build("--images " + File("bayer") + Calibrated());
  ExpectGoodMap(outcome);
  EXPECT_THAT(outcome.output, HasSubstr("raw mosaics"));
}

TEST_F(MapInputsTest, ABagOfRosWithGreyColourOrCompressedImages) {
  {
    rosbag::Bag bag(File("camera.bag"), rosbag::bagmode::Write);
    for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
      const cv::Mat& grey = painted_->pictures[k];
      cv::Mat colour;
      cv::merge(std::vector<cv::Mat>{grey, grey, grey}, colour);
      const Utime t = painted_->poses[k].t;
      Record(&bag, "/camera/left/image_mono", t,
             ImageMessage(t, 200, 150, "mono8", PaintedPictures::Raw(grey)), 30'000);
      Record(&bag, "/camera/left/image", t, ImageMessage(t, 200, 150, "bgr8", PaintedPictures::Raw(colour)));
      Record(&bag, "/camera/left/compressed", t,
             CompressedImageMessage(t, "mono8; png compressed", PaintedPictures::Png(grey)));
    }
  }
  const std::string bag = "--images " + File("camera.bag") + Calibrated();
  ExpectGoodMap(Build(bag + " --topic /camera/left/image_mono"));
  const PointMap grey = LoadMap(File("map.pcd")).map;
  for (const char* topic : {"/camera/left/image", "/camera/left/compressed"}) {
    ExpectGoodMap(Build(bag + " --topic " + topic));
    EXPECT_EQ(LoadMap(File("map.pcd")).map.points, grey.points) << topic;
  }
  ExpectRefused(Build(bag), "choose one with --topic");
}

// rgb.txt, depth.txt, groundtruth.txt, 5000 units of depth per metre; depth is taken a little later.
TEST_F(MapInputsTest, TumsLayoutOfRgbAndDepth) {
  std::string rgb = "# color images\n# timestamp filename\n", depth = "# depth maps\n";
  const Trajectory dense = Dense({});
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
    const StampedPose& pose = painted_->poses[k];
    const Utime later = std::min(pose.t + 12'000, dense.back().t);
    SE3 T_map_depth;
    PoseAt(dense, later, &T_map_depth);
    Write("tum/rgb/" + StampName(pose.t), PaintedPictures::Png(painted_->pictures[k]));
    Write("tum/depth/" + StampName(later),
          PaintedPictures::Png(painted_->scene.Depth(painted_->camera, T_map_depth, 5000)));
    rgb += StampName(pose.t).substr(0, 17) + " rgb/" + StampName(pose.t) + "\n";
    depth += StampName(later).substr(0, 17) + " depth/" + StampName(later) + "\n";
  }
  Write("tum/rgb.txt", rgb);
  Write("tum/depth.txt", depth);
  WriteTum(File("tum/groundtruth.txt"), dense);
  const std::string camera = " --camera " + File("camera.textproto");
  ExpectGoodMap(Build("--rgbd " + File("tum") + camera), 0.01);
  ExpectGoodMap(Build("--images " + File("tum") + " --poses " + File("tum/groundtruth.txt") + camera));
  // TUM's own camera is 640x480.
  ExpectRefused(Build("--rgbd " + File("tum")), "the camera file says 640x480");
  // In millimetres everything would be five times as far.
  const test::ProgramOutcome far = Build("--rgbd " + File("tum") + camera + " --depth-scale 1000");
  EXPECT_TRUE(far.code != 0 || far.output.find("warning") != std::string::npos) << far.output;
}

// VECtor's Kinect: a depth camera of its own beside the grey one, both on a body whose poses are known.
TEST_F(MapInputsTest, DepthOfAnotherCamera) {
  const SE3 T_body_grey(ExpSO3({0.3, -0.2, 0.1}), {0.1, 0, 0.05});
  const SE3 T_grey_depth(ExpSO3({0.01, -0.02, 0.015}), {0.08, -0.03, 0.01});
  WriteCamera("grey.textproto", T_body_grey);
  MountedCamera kinect;
  kinect.camera = painted_->camera;
  kinect.camera.width = 120, kinect.camera.height = 110;
  kinect.camera.fx = kinect.camera.fy = 80;
  kinect.camera.cx = 60, kinect.camera.cy = 55;
  kinect.T_body_camera = T_body_grey * T_grey_depth;
  WriteMountedCamera(File("kinect.textproto"), kinect, "test");
  WriteTum(File("body.tum"), Dense(T_body_grey.Inverse()));
  std::vector<std::pair<std::string, std::string>> depth;
  for (std::size_t k = 0; k < painted_->pictures.size(); ++k) {
    const StampedPose& pose = painted_->poses[k];
    Write("grey/" + StampName(pose.t), PaintedPictures::Png(painted_->pictures[k]));
    depth.emplace_back("depth/" + StampName(pose.t), PaintedPictures::Png(painted_->scene.Depth(
                                                         kinect.camera, pose.pose * T_grey_depth, 1000)));
  }
  WriteZip(File("depth.zip"), depth);
  const std::string arguments = "--images " + File("grey") + " --poses " + File("body.tum") +
                                " --poses-of body --camera " + File("grey.textproto") + " --depth " +
                                File("depth.zip");
  ExpectGoodMap(Build(arguments + " --depth-camera " + File("kinect.textproto")), 0.01);
  ExpectRefused(Build(arguments), "name its own with --depth-camera");
  WriteZip(File("depth.zip"),
           {{"depth/" + StampName(PaintedPictures::begin + 3'000'000'000), depth[0].second}});
  ExpectRefused(Build(arguments + " --depth-camera " + File("kinect.textproto")), "another clock");
}

// The second camera alone gives depth where the body hardly moves.
TEST_F(MapInputsTest, TwoCamerasOnABody) {
  const SE3 T_left_right(ExpSO3({0.01, 0.02, -0.01}), {0.15, 0.01, 0.0});
  const SE3 T_body_left(ExpSO3({0.3, -0.2, 0.1}), {0.1, 0, 0.05});
  WriteCamera("left.textproto", T_body_left);
  WriteCamera("right.textproto", T_body_left * T_left_right);
  const PaintedPictures still(10, 0.004);
  for (std::size_t k = 0; k < still.poses.size(); ++k) {
    Write("left/" + StampName(still.poses[k].t), PaintedPictures::Png(still.pictures[k]));
    Write("right/" + StampName(still.poses[k].t),
          PaintedPictures::Png(still.scene.Picture(still.camera, still.poses[k].pose * T_left_right)));
  }
  WriteTum(File("poses.tum"), still.poses);
  const std::string left =
      "--poses " + File("poses.tum") + " --images " + File("left") + " --camera " + File("left.textproto");
  ExpectGoodMap(Build(left + " --images " + File("right") + " --camera " + File("right.textproto")), 0.01);
  ExpectRefused(Build(left), "depth needs a baseline");
  ExpectRefused(Build(left + " --images " + File("right")), "--camera 1 files: one for each");
}

}  // namespace
}  // namespace evit::commands
