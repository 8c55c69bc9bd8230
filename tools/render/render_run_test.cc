#include "tools/render/render_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/config/rig_file.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/sample_messages.h"

namespace evit::render {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class RenderRunTest : public ::testing::Test {
 protected:
  RenderRunTest() : folder_(fs::path(::testing::TempDir()) / ("evit_render_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    options_.map = test::SourcePath("logs/sample_map.pcd");
    options_.rig = test::SourcePath("logs/rig.textproto");
    options_.log = (folder_ / "run.lcmlog").string();
    options_.out = (folder_ / "run.gif").string();
    options_.paint.size = {320, 180};
    options_.fps = 10;
  }
  ~RenderRunTest() override { fs::remove_all(folder_); }

  template <typename Message>
  static void Write(LogWriter* log, const std::string& channel, const Message& message) {
    std::vector<std::uint8_t> bytes;
    EncodeTo(message, &bytes);
    log->Write(message.utime, channel, bytes.data(), bytes.size());
  }
  // A second of keyframes, 20 ms apart, in front of the sample map; its surface has a bar that moves.
  void Record() {
    const Rig rig = LoadRig(options_.rig);
    LogWriter log(options_.log);
    for (int i = 0; i <= 50; ++i) {
      keyframe_t keyframe = Sample<keyframe_t>();
      keyframe.utime += 20'000 * i;
      keyframe.encoding = keyframe_t::TIME_SURFACE;
      keyframe.width = rig.camera.width;
      keyframe.height = rig.camera.height;
      keyframe.surface_size = keyframe.width * keyframe.height;
      keyframe.surface.assign(static_cast<std::size_t>(keyframe.surface_size), 255);
      std::fill_n(keyframe.surface.begin() + std::ptrdiff_t{keyframe.width} * i, 4 * keyframe.width, 0);
      Write(&log, Channels().keyframe, keyframe);
      window_state_t window = Sample<window_state_t>();
      window.utime = keyframe.utime;
      window.mode = tracker_mode_t::TRACKING;
      window.n_nodes = 1;
      window.node.resize(1);
      window.node[0].position[0] = -0.7 + 0.01 * i;
      Write(&log, Channels().window_state, window);
    }
    log.Close();
  }
  std::string Failure() {
    try {
      RenderRun(options_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
  RenderOptions options_;
};

TEST_F(RenderRunTest, AGifAndAnMp4HoldEachMoment) {
  Record();
  for (const char* name : {"run.gif", "run.mp4"}) {
    options_.out = (folder_ / name).string();
    EXPECT_EQ(RenderRun(options_), 11);
    cv::VideoCapture reader(options_.out, cv::CAP_FFMPEG);
    cv::Mat first, picture, last;
    int n = 0;
    for (; reader.read(picture); ++n) picture.copyTo(n == 0 ? first : last);
    EXPECT_EQ(n, 11) << name;
    EXPECT_EQ(first.size(), options_.paint.size);
    EXPECT_GT(cv::norm(first, last, cv::NORM_L1) / static_cast<double>(first.total()), 0.1) << name;
  }
}

TEST_F(RenderRunTest, OnlyTheChosenSecondsAreDrawn) {
  Record();
  options_.seconds = {0.5, 0.8};
  EXPECT_EQ(RenderRun(options_), 4);
  options_.seconds = {0, 0.05};  // from the first keyframe, which is there before a window
  EXPECT_EQ(RenderRun(options_), 1);
  options_.seconds = {5, 6};
  EXPECT_THAT(Failure(), HasSubstr("not in it"));
}

TEST_F(RenderRunTest, SaysWhatIsWrongAndLeavesNothing) {
  Record();
  options_.out = (folder_ / "run.avi").string();
  EXPECT_THAT(Failure(), HasSubstr(".mp4 or .gif"));
  options_.out = (folder_ / "nowhere" / "run.gif").string();
  EXPECT_THAT(Failure(), HasSubstr("cannot write"));
  options_.log = test::SourcePath("logs/sample.lcmlog");
  options_.out = (folder_ / "run.gif").string();
  EXPECT_THAT(Failure(), HasSubstr("evit run --record"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);  // the recording
}

}  // namespace
}  // namespace evit::render
