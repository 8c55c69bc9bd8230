#include "tools/formats/rgbd/rgbd_folder.h"

#include <Eigen/LU>
#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "common/files/table_reader.h"
#include "common/text/natural_order.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

// Rows of `columns` numbers.
std::vector<std::vector<double>> ReadRows(const std::string& path, std::size_t columns) {
  if (!fs::exists(path))
    throw std::runtime_error(path +
                             ": cannot be read; expected a folder with images/, depth/, poses.txt and K.txt");
  TableReader table(path, std::to_string(columns) + " numbers");
  std::vector<std::vector<double>> rows;
  while (table.Next()) {
    std::vector<double>& row = rows.emplace_back();
    for (std::size_t k = 0; k < columns; ++k) row.push_back(table.Number());
    table.End();
  }
  return rows;
}

SE3 PoseOf(const std::vector<double>& row, const std::string& path, std::size_t number) {
  const Eigen::Matrix4d m = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(row.data());
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  if (!m.allFinite() || !((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-2) ||
      R.determinant() < 0 || !((m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < 1e-6)) {
    throw std::runtime_error(path + ": pose " + std::to_string(number) +
                             ": no camera-to-map transform (4x4 row by row, rotation and metres)");
  }
  return SE3(m);
}

}  // namespace

RgbdFolder::RgbdFolder(const std::string& path) : path_(path) {
  std::error_code error;
  if (!fs::is_directory(path, error))
    throw std::runtime_error(path +
                             ": no such folder; expected one with images/, depth/, poses.txt and K.txt");
  for (const auto& entry : fs::directory_iterator(path + "/images", error)) {
    if (entry.is_regular_file()) names_.push_back(entry.path().filename().string());
  }
  if (error || names_.empty())
    throw std::runtime_error(
        path + "/images: contains no image; expected a folder with images/, depth/, poses.txt and K.txt");
  std::sort(names_.begin(), names_.end(), NaturallyBefore);
  const std::string poses = path + "/poses.txt", intrinsics = path + "/K.txt";
  for (const std::vector<double>& row : ReadRows(poses, 16))
    poses_.push_back(PoseOf(row, poses, poses_.size()));
  if (poses_.size() != names_.size()) {
    throw std::runtime_error(poses + ": has " + std::to_string(poses_.size()) + " poses, but there are " +
                             std::to_string(names_.size()) + " images; expected one row for each");
  }
  const auto rows = ReadRows(intrinsics, 3);
  if (rows.size() != 3 || !(rows[0][0] > 0 && rows[1][1] > 0)) {
    throw std::runtime_error(intrinsics +
                             ": expected three rows of a camera matrix with positive focal lengths");
  }
  camera_.fx = rows[0][0];
  camera_.fy = rows[1][1];
  camera_.cx = rows[0][2];
  camera_.cy = rows[1][2];
}

RgbdView RgbdFolder::Load(std::size_t k) const {
  const std::string image_path = path_ + "/images/" + names_.at(k);
  const std::string depth_path = path_ + "/depth/" + fs::path(names_[k]).stem().string() + ".png";
  cv::Mat image = cv::imread(image_path, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
  const cv::Mat depth = cv::imread(depth_path, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
  if (image.empty()) throw std::runtime_error(image_path + ": cannot be read as an image");
  if (depth.empty())
    throw std::runtime_error(depth_path + ": cannot be read as an image; each image needs its depth");
  if (depth.type() != CV_16UC1)
    throw std::runtime_error(depth_path + ": expected 16-bit depth in millimetres");
  if (depth.size() != image.size())
    throw std::runtime_error(depth_path + ": is not of the size of " + image_path);
  if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
  if (image.channels() == 4) cv::cvtColor(image, image, cv::COLOR_BGRA2GRAY);
  if (image.depth() != CV_8U && image.depth() != CV_16U)
    throw std::runtime_error(image_path + ": expected 8 or 16 bits per channel");
  RgbdView view;
  view.T_map_camera = poses_[k];
  view.camera = camera_;
  view.camera.width = image.cols;
  view.camera.height = image.rows;
  cv::Mat light, metres;
  image.convertTo(light, CV_32F, image.depth() == CV_8U ? 1.0 / 255 : 1.0 / 65535);
  depth.convertTo(metres, CV_32F, 1e-3);
  view.intensity.assign(light.begin<float>(), light.end<float>());
  view.depth.assign(metres.begin<float>(), metres.end<float>());
  return view;
}

}  // namespace evit::formats
