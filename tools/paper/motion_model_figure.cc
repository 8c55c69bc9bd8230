#include "tools/paper/motion_model_figure.h"

#include <cstdio>
#include <stdexcept>

#include "tools/paper/surface_picture.h"
#include "tools/pictures/chart.h"
#include "tools/pictures/write_picture.h"

namespace evit::paper {
namespace {

const cv::Scalar kPoints(40, 40, 230);  // BGR

// The window before a keyframe, the keyframe, and where the window found it.
struct Instant {
  const window_state_t* before = nullptr;
  RecordedKeyframe keyframe;
  SE3 found;  // T_map_body
};

Instant MostSurprising(const KeyframeLog& log, const Rig& rig, const MapIndex& map) {
  Instant best;
  double most = -1;
  const auto& windows = log.windows();
  for (std::size_t k = 1; k < windows.size(); ++k) {
    const window_state_t &before = windows[k - 1], &after = windows[k];
    RecordedKeyframe keyframe;
    // A window of a few nodes has only just begun.
    if (before.n_nodes < 4 || after.keyframe_seq != before.keyframe_seq + 1 ||
        !log.Read(after.keyframe_seq, &keyframe) || keyframe.imu.size() < 2)
      continue;
    const SE3 found = StateOf(after.node.back()).T_map_body;
    const double off = MeanPixelDistance(rig, VisibleFrom(map, rig, found, 300), found,
                                         PredictFrom(before, keyframe, 1, rig.gravity));
    if (off <= most) continue;
    most = off;
    best = {&before, keyframe, found};
  }
  if (best.before == nullptr)
    throw std::runtime_error("no keyframe with a whole window before it was recorded");
  return best;
}

}  // namespace

void DrawMotionModels(const std::string& path, const std::string& title, const KeyframeLog& log,
                      const Rig& rig, const MapIndex& map) {
  const Instant instant = MostSurprising(log, rig, map);
  const std::vector<Eigen::Vector3f> points = VisibleFrom(map, rig, instant.found, 3000);
  const double zoom = 720.0 / instant.keyframe.width;
  const int width = 720, height = static_cast<int>(zoom * instant.keyframe.height), gap = 20, caption = 40,
            top = 50;
  cv::Mat image(top + 2 * (height + caption), 2 * width + 3 * gap, CV_8UC3, cv::Scalar(255, 255, 255));
  pictures::DrawText(&image, title, {image.cols / 2, 34}, 0.8, pictures::Anchor::kCenter, {20, 20, 20}, 2);
  const char* names[] = {"zeroth-order: previous pose", "first-order: constant velocity", "second-order: IMU",
                         "after optimisation"};
  for (int k = 0; k < 4; ++k) {
    const SE3 pose = k == 3 ? instant.found : PredictFrom(*instant.before, instant.keyframe, k, rig.gravity);
    const cv::Mat picture = SurfaceWithPoints(instant.keyframe, rig, points, pose, kPoints, zoom);
    const cv::Rect where(gap + (k % 2) * (width + gap), top + (k / 2) * (height + caption), picture.cols,
                         picture.rows);
    picture.copyTo(image(where));
    char text[120];
    if (k == 3) {
      std::snprintf(text, sizeof text, "%s", names[k]);
    } else {
      std::snprintf(text, sizeof text, "%s, %.1f px off", names[k],
                    MeanPixelDistance(rig, points, instant.found, pose));
    }
    pictures::DrawText(&image, text, {where.x + width / 2, where.y + height + 26}, 0.65,
                       pictures::Anchor::kCenter);
  }
  pictures::WritePicture(path, image);
}

}  // namespace evit::paper
