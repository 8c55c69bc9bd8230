#include "tools/mapping/check_pictures.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "common/config/rig_file.h"

namespace evit::mapping {
namespace {

cv::Mat Picture(const Rig& rig, const MapView& view) {
  cv::Mat picture(rig.camera.height, rig.camera.width, CV_8UC3, cv::Scalar(255, 255, 255));
  for (int row = 0; row < picture.rows; ++row) {
    for (int column = 0; column < picture.cols; ++column) {
      if (view.fired.Has(column, row)) picture.at<cv::Vec3b>(row, column) = {180, 180, 180};
    }
  }
  const NearestPixel near(OverlapOptions().radius_px);
  const SE3 T = (view.T_map_body * rig.T_body_camera).Inverse();
  for (const Eigen::Vector3f& p : view.points) {
    Eigen::Vector2d pixel, offset;
    if (!rig.camera.Project(T * p.cast<double>(), &pixel) || !rig.camera.Contains(pixel, 0)) continue;
    const cv::Point at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
    picture.at<cv::Vec3b>(at) =
        near.Find(view.fired, pixel, &offset) ? cv::Vec3b(178, 114, 0) : cv::Vec3b(0, 94, 213);
  }
  return picture;
}

}  // namespace

void WriteCheckPictures(const std::string& folder, const std::string& rig_path, const MapCheck& check) {
  const Rig rig = LoadRig(rig_path);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": cannot be made: " + error.message());
  std::vector<std::size_t> order(check.views.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return check.moments[a].kappa() > check.moments[b].kappa();
  });
  const std::pair<const char*, std::size_t> pictures[] = {
      {"best", order.front()}, {"median", order[order.size() / 2]}, {"worst", order.back()}};
  for (const auto& [name, view] : pictures) {
    const std::string path = folder + "/" + name + ".png";
    if (!cv::imwrite(path, Picture(rig, check.views[view])))
      throw std::runtime_error(path + ": cannot be written");
  }
}

}  // namespace evit::mapping
