#include "tools/paper/window_figure.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/paper/surface_picture.h"
#include "tools/pictures/chart.h"
#include "tools/pictures/top_view.h"
#include "tools/pictures/write_picture.h"

namespace evit::paper {
namespace {

constexpr int kPlan = 760;       // pixels of the square that holds the plan, and of the detail beside it
constexpr int kThumbnail = 320;  // pixels of a surface's width
constexpr int kGapPx = 20, kTop = 60;
constexpr int kShift = 4;  // sub-pixel positions

// Oldest keyframe blue, newest red. BGR.
cv::Scalar ColorOf(std::size_t k, std::size_t n) {
  cv::Mat level(1, 1, CV_8U, cv::Scalar(n < 2 ? 255.0 : 30 + 225.0 * static_cast<double>(k) / (n - 1.0))),
      color;
  cv::applyColorMap(level, color, cv::COLORMAP_TURBO);
  const auto c = color.at<cv::Vec3b>(0, 0);
  return {double(c[0]), double(c[1]), double(c[2])};
}

const window_state_t& LongestWindow(const KeyframeLog& log) {
  const window_state_t* best = nullptr;
  double longest = -1;
  for (const window_state_t& window : log.windows()) {
    const bool whole =
        window.n_nodes >= 3 && std::all_of(window.node.begin(), window.node.end(),
                                           [&](const auto& n) { return log.Has(n.keyframe_seq); });
    const double way =
        (Eigen::Vector3d(window.node.back().position) - Eigen::Vector3d(window.node.front().position)).norm();
    if (whole && way > longest) longest = way, best = &window;
  }
  if (best == nullptr) throw std::runtime_error("no window was recorded with all its keyframes");
  return *best;
}

cv::Point Fine(const cv::Point2d& at) {
  return {static_cast<int>(std::lround(at.x * (1 << kShift))),
          static_cast<int>(std::lround(at.y * (1 << kShift)))};
}

// What a camera sees, from above: its centre and both ends, `depth` metres before it.
std::vector<Eigen::Vector3d> WedgeOf(const Camera& camera, const SE3& T_map_camera, double depth) {
  std::vector<Eigen::Vector3d> wedge{T_map_camera.p};
  for (const double x : {0.0, camera.width - 1.0}) {
    Eigen::Vector3d ray(0, 0, 1);
    if (camera.Unproject({x, camera.cy}, &ray)) wedge.push_back(T_map_camera * (depth * ray));
  }
  return wedge;
}

template <typename At>
void DrawWedge(cv::Mat* image, const At& at, const std::vector<Eigen::Vector3d>& wedge,
               const cv::Scalar& color) {
  std::vector<cv::Point> corners;
  for (const Eigen::Vector3d& p : wedge) corners.push_back(Fine(at(p)));
  cv::polylines(*image, corners, true, color, 2, cv::LINE_AA, kShift);
  cv::circle(*image, corners.front(), 4 << kShift, color, cv::FILLED, cv::LINE_AA, kShift);
}

// The cameras alone, as large as they fit.
cv::Mat Detail(const std::vector<SE3>& cameras, const Camera& camera) {
  cv::Mat image(kPlan, kPlan, CV_8UC3, cv::Scalar(255, 255, 255));
  Eigen::Vector2d low = cameras.front().p.head<2>(), high = low;
  for (const SE3& c : cameras) {
    low = low.cwiseMin(c.p.head<2>());
    high = high.cwiseMax(c.p.head<2>());
  }
  const double span = std::max(0.02, (high - low).maxCoeff()), depth = 0.5 * span;
  for (const SE3& c : cameras) {
    for (const Eigen::Vector3d& corner : WedgeOf(camera, c, depth)) {
      low = low.cwiseMin(corner.head<2>());
      high = high.cwiseMax(corner.head<2>());
    }
  }
  const double scale = 0.85 * kPlan / (high - low).maxCoeff();
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const auto at = [&](const Eigen::Vector3d& p) {
    return cv::Point2d(0.5 * kPlan + scale * (p.x() - middle.x()),
                       0.5 * kPlan - scale * (p.y() - middle.y()));
  };
  for (std::size_t k = 1; k < cameras.size(); ++k) {  // the IMU joins neighbours
    cv::line(image, Fine(at(cameras[k - 1].p)), Fine(at(cameras[k].p)), {90, 90, 90}, 3, cv::LINE_AA, kShift);
  }
  for (std::size_t k = 0; k < cameras.size(); ++k)
    DrawWedge(&image, at, WedgeOf(camera, cameras[k], depth), ColorOf(k, cameras.size()));
  const double bar = span >= 0.1 ? 0.1 : 0.01;
  cv::line(image, {30, kPlan - 30}, {30 + static_cast<int>(bar * scale), kPlan - 30}, {60, 60, 60}, 3);
  pictures::DrawText(&image, bar > 0.05 ? "10 cm" : "1 cm", {30, kPlan - 40}, 0.5, pictures::Anchor::kLeft);
  cv::rectangle(image, {0, 0, kPlan, kPlan}, {190, 190, 190});
  return image;
}

}  // namespace

void DrawWindow(const std::string& path, const std::string& title, const KeyframeLog& log, const Rig& rig,
                const MapIndex& map) {
  const window_state_t& window = LongestWindow(log);
  const std::size_t n = window.node.size();
  std::vector<SE3> cameras;
  for (const node_state_t& node : window.node)
    cameras.push_back(StateOf(node).T_map_body * rig.T_body_camera);

  std::vector<Eigen::Vector2d> in_view;
  for (const SE3& c : cameras)
    in_view.emplace_back(c.p.head<2>() - 0.2 * (c.q * Eigen::Vector3d::UnitZ()).head<2>());
  pictures::TopView plan = pictures::DrawTopView(map.map(), kPlan - 60, in_view);
  const auto at = [&](const Eigen::Vector3d& p) { return plan.At(p.x(), p.y()); };
  for (std::size_t k = 0; k < n; ++k)
    DrawWedge(&plan.picture, at, WedgeOf(rig.camera, cameras[k], 1.0), ColorOf(k, n));

  const int columns = static_cast<int>(n), thumb_height = kThumbnail * rig.camera.height / rig.camera.width;
  const int upper = std::max(plan.picture.rows, kPlan);
  const int width =
      std::max(plan.picture.cols + kPlan + 3 * kGapPx, columns * (kThumbnail + kGapPx) + kGapPx);
  cv::Mat image(kTop + upper + 50 + thumb_height + kGapPx, width, CV_8UC3, cv::Scalar(255, 255, 255));
  pictures::DrawText(&image, title, {width / 2, 38}, 0.8, pictures::Anchor::kCenter, {20, 20, 20}, 2);
  plan.picture.copyTo(image(cv::Rect({kGapPx, kTop}, plan.picture.size())));
  Detail(cameras, rig.camera).copyTo(image(cv::Rect(width - kPlan - kGapPx, kTop, kPlan, kPlan)));
  const int y = kTop + upper + 40;
  const int left = (width - columns * (kThumbnail + kGapPx) + kGapPx) / 2;
  for (std::size_t k = 0; k < n; ++k) {
    RecordedKeyframe keyframe;
    if (!log.Read(window.node[k].keyframe_seq, &keyframe)) continue;
    const SE3 pose = StateOf(window.node[k]).T_map_body;
    const cv::Mat picture =
        SurfaceWithPoints(keyframe, rig, VisibleFrom(map, rig, pose, 2500), pose, {40, 40, 230},
                          static_cast<double>(kThumbnail) / keyframe.width);
    const cv::Rect where(left + static_cast<int>(k) * (kThumbnail + kGapPx), y, picture.cols, picture.rows);
    picture.copyTo(image(where));
    cv::rectangle(image, where, ColorOf(k, n), 4);
    char text[40];
    std::snprintf(text, sizeof text, "%.0f ms",
                  1e-3 * static_cast<double>(window.node[k].utime - window.utime));
    pictures::DrawText(&image, text, {where.x + kThumbnail / 2, y - 10}, 0.5, pictures::Anchor::kCenter);
  }
  pictures::WritePicture(path, image);
}

}  // namespace evit::paper
