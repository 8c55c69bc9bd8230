// Pictures of a run: what they show, and what they leave out where there is nothing to show.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "tests/helpers/temporary_folder.h"
#include "tools/pictures/consistency_plot.h"
#include "tools/pictures/run_plot.h"

namespace evit::pictures {
namespace {

const TimeAxis kSecond{0, 0, kMicrosPerSecond};

// A second along x, `beside` m off.
Trajectory Straight(double beside = 0) {
  Trajectory line;
  for (int k = 0; k <= 100; ++k)
    line.push_back({Utime{10'000} * k, {Eigen::Quaterniond::Identity(), {0.01 * k, beside, 1}}});
  return line;
}

TEST(ConsistencyPlot, ShowsTheBoundsWhereTheRunIsScored) {
  const TemporaryFolder folder("consistency_plot");
  const Trajectory truth = Straight(), estimate = Straight(0.02);
  Covariances covariances;
  for (const StampedPose& pose : estimate) covariances.push_back({pose.t, 1e-4 * Matrix6d::Identity()});
  const Consistency consistency = ConsistencyOf(truth, estimate, covariances);
  for (const bool scored : {true, false}) {
    PlotConsistency(folder.File("plot.png"), "title", scored ? consistency : Consistency{}, kSecond);
    const cv::Mat image = cv::imread(folder.File("plot.png"));
    EXPECT_GT(image.cols, 1000);
    cv::Mat bounds;
    cv::inRange(image, cv::Scalar(170, 170, 170), cv::Scalar(170, 170, 170), bounds);
    EXPECT_EQ(cv::countNonZero(bounds) > 5000, scored);  // the legend is there always
  }
}

TEST(RunPlot, WithAndWithoutTruthOrPoses) {
  const TemporaryFolder folder("run_plot");
  const Trajectory truth = Straight();
  for (const auto& [a, b] : {std::pair(truth, truth), std::pair(Trajectory(), truth),
                             std::pair(truth, Trajectory()), std::pair(Trajectory(), Trajectory())}) {
    PlotRun(folder.File("plot.png"), "title", a, b, kSecond);
    const cv::Mat image = cv::imread(folder.File("plot.png"));
    EXPECT_GT(image.cols, 1000);
    // Blue, the colour of the path and of z, shows where and only where there are poses.
    cv::Mat blue;
    cv::inRange(image, cv::Scalar(178, 114, 0), cv::Scalar(178, 114, 0), blue);
    EXPECT_EQ(cv::countNonZero(blue) > 500, !b.empty());
  }
}

// So that runs with and without a start pose line up, with truth and without.
TEST(RunPlot, TimeZeroIsTheRecordingsStartWhateverTheFirstPose) {
  const TemporaryFolder folder("run_plot");
  const Trajectory whole = Straight(), late(whole.begin() + 50, whole.end());
  // First and last column with blue in a chart over time.
  const auto columns = [&](const Trajectory& truth, const Trajectory& estimate) {
    PlotRun(folder.File("plot.png"), "title", truth, estimate, kSecond);
    cv::Mat blue;
    cv::inRange(cv::imread(folder.File("plot.png"))(cv::Rect(10, 100, 960, 270)), cv::Scalar(178, 114, 0),
                cv::Scalar(178, 114, 0), blue);
    const cv::Rect box = cv::boundingRect(blue);
    return std::pair(box.x, box.x + box.width);
  };
  for (const Trajectory& truth : {whole, Trajectory()}) {
    const auto of_whole = columns(truth, whole), of_late = columns(truth, late);
    EXPECT_NEAR(of_late.first, 0.5 * (of_whole.first + of_whole.second), 25);  // a dash's gap may be there
    EXPECT_NEAR(of_late.second, of_whole.second, 25);
  }
}

// A gap of 0.2 s, shorter than those that break lines by themselves, neither over time nor from above.
TEST(RunPlot, DrawsNoLineOverABreak) {
  const TemporaryFolder folder("run_plot");
  Trajectory estimate = Straight();
  estimate.erase(estimate.begin() + 41, estimate.begin() + 60);
  const auto ink = [&](const std::vector<Utime>& breaks, const cv::Rect& chart) {
    PlotRun(folder.File("plot.png"), "title", Trajectory(), estimate, kSecond, breaks);
    cv::Mat blue;
    cv::inRange(cv::imread(folder.File("plot.png"))(chart), cv::Scalar(178, 114, 0), cv::Scalar(178, 114, 0),
                blue);
    return cv::countNonZero(blue);
  };
  for (const cv::Rect& chart : {cv::Rect(10, 100, 960, 300), cv::Rect(980, 100, 510, 660)})
    EXPECT_LT(ink({estimate[41].t}, chart), 0.9 * ink({}, chart));
}

}  // namespace
}  // namespace evit::pictures
