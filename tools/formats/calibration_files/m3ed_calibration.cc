#include "tools/formats/calibration_files/m3ed_calibration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "tools/formats/hdf5/h5_file.h"

namespace evit::formats {
namespace {

// github.com/daniilidis-group/m3ed, build_system/calibration/vn100.yaml
constexpr ImuNoise kVn100{6.10866e-5, 1.372e-3, 4e-6, 5e-5};
constexpr double kRate = 400;  // Hz

std::vector<double> Numbers(const H5File& file, const std::string& name, std::size_t n) {
  const H5Rows rows = file.Open(name);
  if (rows.rows() * rows.columns() != n)
    rows.Fail("has " + std::to_string(rows.rows() * rows.columns()) + " numbers, expected " +
              std::to_string(n));
  return rows.ReadAll<double>();
}

SE3 Transform(const H5File& file, const std::string& name) {
  const std::vector<double> m = Numbers(file, name, 16);
  const Eigen::Matrix4d T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || R.determinant() < 0)
    file.Open(name).Fail("is not a rigid transformation");
  return SE3(T);
}

Camera ReadCamera(const H5File& file, const std::string& group) {
  Camera camera;
  const std::string model = file.Text(group + "distortion_model");
  if (!CameraModelFromName(model, &camera.model)) {
    throw std::runtime_error(file.path() + ": " + group + "distortion_model is \"" + model +
                             "\"; expected radtan or equidistant");
  }
  const std::vector<double> f = Numbers(file, group + "intrinsics", 4),
                            d = Numbers(file, group + "distortion_coeffs", 4),
                            size = Numbers(file, group + "resolution", 2);
  if (!(f[0] > 0 && f[1] > 0)) file.Open(group + "intrinsics").Fail("focal lengths must be positive");
  if (!(size[0] >= 16 && size[1] >= 16 && size[0] <= 8192 && size[1] <= 8192))
    file.Open(group + "resolution").Fail("expected 16 to 8192 pixels");
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  camera.fx = f[0], camera.fy = f[1], camera.cx = f[2], camera.cy = f[3];
  std::copy(d.begin(), d.end(), camera.distortion.begin());
  return camera;
}

}  // namespace

Rig ReadM3edCalibration(const std::string& path, const std::string& side) {
  const H5File file(path);
  Rig rig;
  rig.camera = ReadCamera(file, "prophesee/" + side + "/calib/");
  const SE3 T_body_left = Transform(file, "ovc/imu/calib/T_to_prophesee_left").Inverse();
  rig.T_body_camera = T_body_left * Transform(file, "prophesee/" + side + "/calib/T_to_prophesee_left");
  rig.T_marker_body = T_body_left.Inverse();
  rig.imu_noise = kVn100;
  rig.imu_rate_hz = kRate;
  return rig;
}

}  // namespace evit::formats
