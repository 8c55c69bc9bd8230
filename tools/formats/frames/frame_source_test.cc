#include "tools/formats/frames/frame_source.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "tests/helpers/ros_bags.h"
#include "tests/helpers/temporary_folder.h"
#include "tests/helpers/zip_files.h"
#include "tools/formats/frames/decode_picture.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string Png(int grey) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat(4, 6, CV_8U, cv::Scalar(grey)), bytes);
  return {bytes.begin(), bytes.end()};
}

class FrameSourceTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.File(name); }
  void Write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(Path(name)).parent_path());
    std::ofstream(Path(name), std::ios::binary) << text;
  }
  static std::vector<std::string> Stamps(const FrameSource& source) {
    std::vector<std::string> stamps;
    for (const FrameSource::Frame& frame : source.frames()) stamps.push_back(frame.stamp);
    return stamps;
  }
  static std::vector<int> Greys(FrameSource* source) {
    std::vector<int> greys;
    for (std::size_t k = 0; k < source->frames().size(); ++k)
      greys.push_back(DecodeGrey(source->Fetch(k), source->frames()[k].name).at<std::uint8_t>(1, 1));
    return greys;
  }
  std::string Error(const std::string& name, const FrameSourceOptions& options = {}) const {
    try {
      Greys(OpenFrames(Path(name), options).get());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

 private:
  TemporaryFolder folder_{"frame_source"};
};

TEST_F(FrameSourceTest, PicturesComeInNaturalOrderWithTheStampsOfTheirNames) {
  Write("a/10.png", Png(10));
  Write("a/9.png", Png(9));
  auto source = OpenFrames(Path("a"), {});
  EXPECT_THAT(Greys(source.get()), ElementsAre(9, 10));
  EXPECT_THAT(Stamps(*source), ElementsAre("", ""));
  Write("b/left_1600000000.200000.png", Png(2));
  Write("b/left_1600000000.100000.png", Png(1));
  Write("c/1600000000100000000.PNG", Png(3));
  EXPECT_THAT(Stamps(*OpenFrames(Path("b"), {})), ElementsAre("1600000000.100000", "1600000000.200000"));
  EXPECT_THAT(Stamps(*OpenFrames(Path("c"), {})), ElementsAre("1600000000100000000"));
  Write("d/1600000000.png", Png(1));  // whole seconds, no count
  Write("d/1600000001.png", Png(2));
  EXPECT_THAT(Stamps(*OpenFrames(Path("d"), {})), ElementsAre("1600000000", "1600000001"));
}

// As an archive unpacks, EuRoC and KITTI lay pictures out.
TEST_F(FrameSourceTest, FindsThePicturesOneFolderDownAndListsBesideThem) {
  Write("euroc/cam0/data/0001.png", Png(1));
  Write("euroc/cam0/data/0002.png", Png(2));
  Write("euroc/cam0/data.csv",
        "#timestamp [ns],filename\n1400000000000000001,0001.png\n1400000000050000001,0002.png\n");
  EXPECT_THAT(Stamps(*OpenFrames(Path("euroc/cam0"), {})),
              ElementsAre("1400000000000000001", "1400000000050000001"));
  EXPECT_THAT(Stamps(*OpenFrames(Path("euroc/cam0/data"), {})),
              ElementsAre("1400000000000000001", "1400000000050000001"));
  Write("kitti/image_0/000.png", Png(1));
  Write("kitti/image_0/001.png", Png(1));
  Write("kitti/times.txt", "0.0\n0.1\n");
  EXPECT_THAT(Stamps(*OpenFrames(Path("kitti/image_0"), {})), ElementsAre("0.0", "0.1"));
}

TEST_F(FrameSourceTest, TumsColourAndDepthHaveListsOfTheirOwn) {
  for (const char* name : {"rgb/1.png", "rgb/2.png"}) Write(std::string("tum/") + name, Png(1));
  for (const char* name : {"depth/1.png", "depth/2.png"}) Write(std::string("tum/") + name, Png(7));
  Write("tum/rgb.txt",
        "# color images\n# timestamp filename\n5.1 rgb/1.png\n5.2 rgb/2.png\n5.3 rgb/gone.png\n");
  Write("tum/depth.txt", "5.11 depth/1.png\n5.21 depth/2.png\n");
  for (const char* path : {"tum", "tum/rgb"}) {
    auto colour = OpenFrames(Path(path), {});
    EXPECT_THAT(Stamps(*colour), ElementsAre("5.1", "5.2")) << path;
    EXPECT_THAT(Greys(colour.get()), ElementsAre(1, 1));
  }
  for (const char* path : {"tum", "tum/depth"}) {
    auto depth = OpenFrames(Path(path), {"", true});
    EXPECT_THAT(Stamps(*depth), ElementsAre("5.11", "5.21")) << path;
    EXPECT_THAT(Greys(depth.get()), ElementsAre(7, 7));
  }
}

TEST_F(FrameSourceTest, AZipIsReadInPlace) {
  const std::string one = Png(1), two = Png(2), ten = Png(10);
  WriteZip(Path("left.zip"), {{"left_camera/1600000000.200000.png", two},
                              {"left_camera/1600000000.100000.png", one},
                              {"__MACOSX/left_camera/._1600000000.100000.png", "rubbish"},
                              {"left_camera/readme.md", "about"}});
  auto source = OpenFrames(Path("left.zip"), {});
  EXPECT_THAT(Greys(source.get()), ElementsAre(1, 2));
  EXPECT_THAT(Stamps(*source), ElementsAre("1600000000.100000", "1600000000.200000"));
  WriteZip(Path("listed.zip"), {{"pics/a.png", ten}, {"pics/images.txt", "7.5 a.png\n"}});
  EXPECT_THAT(Stamps(*OpenFrames(Path("listed.zip"), {})), ElementsAre("7.5"));
}

TEST_F(FrameSourceTest, ABagsImagesHaveTheStampsOfTheirHeaders) {
  const std::string grey(24, 'A'), colour(72, 'A');
  {
    rosbag::Bag bag(Path("a.bag"), rosbag::bagmode::Write);
    for (Utime t = 1'600'000'000'000'000; t < 1'600'000'000'300'000; t += 100'000) {
      Record(&bag, "/camera/left/image_mono", t, ImageMessage(t, 6, 4, "mono8", grey), 4000);
      Record(&bag, "/camera/right/compressed", t, CompressedImageMessage(t, "png", Png(9)));
      Record(&bag, "/camera/depth/image", t, ImageMessage(t, 6, 4, "16UC1", grey + grey));
    }
  }
  auto left = OpenFrames(Path("a.bag"), {"/camera/left/image_mono"});
  EXPECT_THAT(Stamps(*left), ElementsAre("1600000000.000000", "1600000000.100000", "1600000000.200000"));
  EXPECT_THAT(Greys(left.get()), ElementsAre('A', 'A', 'A'));
  EXPECT_EQ(DecodeGrey(left->Fetch(0), "").size(), cv::Size(6, 4));  // back again
  EXPECT_THAT(Greys(OpenFrames(Path("a.bag"), {"/camera/right/compressed"}).get()), ElementsAre(9, 9, 9));
  EXPECT_FLOAT_EQ(DecodeDepth(OpenFrames(Path("a.bag"), {"", true})->Fetch(1), 1000, "").at<float>(0, 0),
                  16.705F);
  EXPECT_THAT(Error("a.bag"), HasSubstr("choose one with --topic: /camera"));
  EXPECT_THAT(Error("a.bag", {"/camera/middle"}), HasSubstr("there is no such topic"));
}

TEST_F(FrameSourceTest, ErrorsNameWhatIsWrongAndTheRemedy) {
  EXPECT_THAT(Error("nowhere"), HasSubstr("nowhere: there is no such folder or file"));
  Write("empty/readme.md", "x");
  EXPECT_THAT(Error("empty"), HasSubstr("contains no picture"));
  Write("stereo/left/1.png", Png(1));
  Write("stereo/right/1.png", Png(1));
  EXPECT_THAT(Error("stereo"), HasSubstr("several folders: left, right"));
  Write("a.tgz", "\x1f\x8b\x08");
  EXPECT_THAT(Error("a.tgz"), HasSubstr("unpack other archives"));
  Write("b.zip", "PK\x03\x04 cut off");
  EXPECT_THAT(Error("b.zip"), HasSubstr("cannot be read ("));
  Write("pics/1.png", Png(1));
  Write("pics/2.png", Png(1));
  Write("pics/images.txt", "0.5\n");
  EXPECT_THAT(Error("pics"), HasSubstr("1 rows hold a stamp and no name, but there are 2 pictures"));
  EXPECT_THAT(Error("pics", {"/camera"}), HasSubstr("is not a ROS bag"));
  {
    rosbag::Bag bag(Path("imu.bag"), rosbag::bagmode::Write);
    Record(&bag, "/imu", 5'000'000, ImuMessage({}));
  }
  EXPECT_THAT(Error("imu.bag"), HasSubstr("no topic holds images"));
}

}  // namespace
}  // namespace evit::formats
