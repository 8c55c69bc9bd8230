#include <gtest/gtest.h>

#include <cstdio>

#include "tests/helpers/paths.h"
#include "tools/feed/feed_loop.h"

namespace evit::feed {
namespace {

// What a program writes on its standard output.
class ProgramInput : public FeedInput {
 public:
  explicit ProgramInput(const std::string& command) : pipe_(popen(command.c_str(), "r")) {}
  ~ProgramInput() override { EXPECT_EQ(pclose(pipe_), 0); }
  State Read(std::uint8_t* out, std::size_t capacity, int, std::size_t* n) override {
    *n = std::fread(out, 1, capacity, pipe_);
    return *n > 0 ? State::kData : State::kEnd;
  }
  std::string name() const override { return "example"; }

 private:
  std::FILE* pipe_;
};

void ExpectExample(const std::string& command) {
  ProgramInput input(command);
  FeedOptions options;
  options.width = 346;
  options.height = 260;
  FeedPublisher publisher(options, Channels(), 1,
                          [](Utime, const std::string&, const std::vector<std::uint8_t>&) {});
  RunFeed(
      &input, &publisher, [] { return false; }, [](const FeedCounts&) {});
  EXPECT_EQ(publisher.counts().events, 5000);
  EXPECT_EQ(publisher.counts().imu, 100);
  EXPECT_EQ(publisher.counts().late + publisher.counts().outside + publisher.counts().invalid, 0);
}

TEST(FeedExamples, ThePythonExampleFeedsEventsAndImu) {
  if (std::system("python3 --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no python3";
  ExpectExample("python3 '" + test::SourcePath("docs/examples/feed_camera.py") + "'");
}

TEST(FeedExamples, TheCppExampleFeedsEventsAndImu) {
  ExpectExample("'" + test::ProgramPath("feed_camera_example") + "'");
}

}  // namespace
}  // namespace evit::feed
