#include "common/config/kalibr_file.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/config/config_error.h"
#include "common/files/table_reader.h"
#include "common/text/words.h"

namespace evit {
namespace {

using Yaml = std::map<std::string, std::vector<std::string>>;

// "FILE#CAMERA,IMU" taken apart.
struct Parts {
  std::string chain, camera = "cam0", imu;
};

Parts PartsOf(const std::string& path) {
  Parts parts;
  const std::size_t comma = path.find(',');
  parts.chain = path.substr(0, comma);
  if (comma != std::string::npos) parts.imu = path.substr(comma + 1);
  const std::size_t hash = parts.chain.rfind('#');
  if (hash != std::string::npos) {
    parts.camera = parts.chain.substr(hash + 1);
    parts.chain.resize(hash);
  }
  if (!parts.imu.empty()) return parts;
  const std::filesystem::path chain(parts.chain);
  std::vector<std::string> beside{(chain.parent_path() / "imu.yaml").string()};
  for (const char* end : {"camchain-imucam.yaml", "camchain.yaml"}) {
    if (EndsWith(parts.chain, end))
      beside.insert(beside.begin(),
                    parts.chain.substr(0, parts.chain.size() - std::string(end).size()) + "imu.yaml");
  }
  std::error_code error;
  for (const std::string& file : beside) {
    if (parts.imu.empty() && std::filesystem::is_regular_file(file, error)) parts.imu = file;
  }
  return parts;
}

Yaml Load(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  if (!file || !(text << file.rdbuf()))
    throw ConfigError(path + ": cannot be read; expected a file of Kalibr");
  return ParseSimpleYaml(text.str(), path);
}

// The values of one file, below a prefix.
struct Values {
  const Yaml& yaml;
  std::string path, prefix;

  [[noreturn]] void Fail(const std::string& key, const std::string& what) const {
    throw ConfigError(path + ": " + prefix + key + ": " + what);
  }
  bool Has(const std::string& key) const { return yaml.count(prefix + key) > 0; }
  const std::vector<std::string>& Words(const std::string& key, std::size_t n) const {
    const auto found = yaml.find(prefix + key);
    if (found == yaml.end()) Fail(key, "is missing");
    if (found->second.size() != n)
      Fail(key, std::to_string(n) + " values are expected, got " + std::to_string(found->second.size()));
    return found->second;
  }
  std::vector<double> Numbers(const std::string& key, std::size_t n) const {
    std::vector<double> numbers;
    for (const std::string& word : Words(key, n)) {
      double value = 0;
      if (!ParseNumber(word, &value) || !std::isfinite(value)) Fail(key, "\"" + word + "\" is not a number");
      numbers.push_back(value);
    }
    return numbers;
  }
  double Number(const std::string& key) const { return Numbers(key, 1)[0]; }
};

Camera ToCamera(const Values& v) {
  Camera camera;
  if (v.Words("camera_model", 1)[0] != "pinhole")
    v.Fail("camera_model", "\"" + v.Words("camera_model", 1)[0] +
                               "\" is not known; calibrate with pinhole-radtan or pinhole-equi");
  const std::string model = v.Has("distortion_model") ? v.Words("distortion_model", 1)[0] : "none";
  if (model == "equidistant" || model == "equi") {
    camera.model = Camera::Model::kEquidistant;
  } else if (model != "radtan" && model != "none") {
    v.Fail("distortion_model",
           "\"" + model + "\" is not known; calibrate with pinhole-radtan or pinhole-equi");
  }
  if (model != "none") {
    const std::vector<double> d = v.Numbers("distortion_coeffs", 4);
    std::copy(d.begin(), d.end(), camera.distortion.begin());
  }
  const std::vector<double> f = v.Numbers("intrinsics", 4), size = v.Numbers("resolution", 2);
  if (!(size[0] >= 16 && size[0] <= 8192 && size[1] >= 16 && size[1] <= 8192))
    v.Fail("resolution", "16 to 8192 pixels each");
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  camera.fx = f[0];
  camera.fy = f[1];
  camera.cx = f[2];
  camera.cy = f[3];
  if (!(camera.fx > 0 && camera.fy > 0)) v.Fail("intrinsics", "the focal lengths must be positive");
  if (!(camera.cx >= 0 && camera.cx <= camera.width && camera.cy >= 0 && camera.cy <= camera.height))
    v.Fail("intrinsics", "the principal point must lie in the image");
  return camera;
}

SE3 ToBodyCamera(const Values& v) {
  if (!v.Has("T_cam_imu"))
    v.Fail("T_cam_imu", "is missing: give the camchain-imucam.yaml that kalibr_calibrate_imu_camera wrote");
  const std::vector<double> m = v.Numbers("T_cam_imu", 16);
  const Eigen::Matrix4d T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || R.determinant() < 0 ||
      !((T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < 1e-9))
    v.Fail("T_cam_imu", "is not a rigid transformation (4x4, row by row)");
  return SE3(T).Inverse();
}

void ReadImu(const std::string& path, Rig* rig) {
  const Yaml yaml = Load(path);
  const std::string prefix = yaml.count("imu0.gyroscope_noise_density") > 0 ? "imu0." : "";
  const Values v{yaml, path, prefix};
  rig->imu_noise = {v.Number("gyroscope_noise_density"), v.Number("accelerometer_noise_density"),
                    v.Number("gyroscope_random_walk"), v.Number("accelerometer_random_walk")};
  for (const double value : {rig->imu_noise.gyro_density, rig->imu_noise.accel_density,
                             rig->imu_noise.gyro_random_walk, rig->imu_noise.accel_random_walk}) {
    if (!(value > 0 && value < 10)) v.Fail("noise", "densities and walks must be positive, rad/s and m/s^2");
  }
  rig->imu_rate_hz = v.Number("update_rate");
  if (!(rig->imu_rate_hz >= 50 && rig->imu_rate_hz <= 10'000)) v.Fail("update_rate", "50 to 10000 Hz");
}

}  // namespace

Yaml ParseSimpleYaml(const std::string& text, const std::string& path) {
  Yaml yaml;
  std::vector<std::pair<std::size_t, std::string>> open;  // indentation and path of the maps around
  std::string current;                                    // the key that list lines belong to
  std::istringstream lines(text);
  std::string line;
  const auto add = [&](const std::string& value) {
    std::string spaced = value;
    for (char& c : spaced) {
      if (c == '[' || c == ']' || c == ',' || c == '"' || c == '\'') c = ' ';
    }
    std::istringstream words(spaced);
    for (std::string word; words >> word;) yaml[current].push_back(word);
  };
  for (int number = 1; std::getline(lines, line); ++number) {
    line = line.substr(0, line.find('#'));
    const std::size_t indent = line.find_first_not_of(" \t\r");
    if (indent == std::string::npos || line.rfind("%YAML", 0) == 0 || line.rfind("---", 0) == 0) continue;
    if (line[indent] == '-' && indent + 1 < line.size() &&
        (line[indent + 1] == ' ' || line[indent + 1] == '[')) {
      if (current.empty()) throw ConfigError(path + ":" + std::to_string(number) + ": a list without a key");
      // "- - 0.1": a list in a list, as newer versions of PyYAML write the rows of a matrix.
      std::size_t value = indent + 1;
      for (std::size_t at = value;
           (at = line.find_first_not_of(" \t", at)) != std::string::npos && line.compare(at, 2, "- ") == 0;)
        value = at = at + 1;
      add(line.substr(value));
      continue;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) {  // a list that continues
      if (current.empty())
        throw ConfigError(path + ":" + std::to_string(number) + ": expected \"key: value\"");
      add(line);
      continue;
    }
    while (!open.empty() && open.back().first >= indent) open.pop_back();
    const std::string key = line.substr(indent, colon - indent);
    current = (open.empty() ? "" : open.back().second + ".") + key;
    open.emplace_back(indent, current);
    add(line.substr(colon + 1));
  }
  return yaml;
}

bool IsKalibr(const std::string& path) {
  const std::string chain = path.substr(0, path.find_first_of(",#"));
  return EndsWith(chain, ".yaml") || EndsWith(chain, ".yml");
}

Rig LoadKalibrRig(const std::string& path) {
  const Parts parts = PartsOf(path);
  const Yaml yaml = Load(parts.chain);
  const Values v{yaml, parts.chain, parts.camera + "."};
  Rig rig;
  rig.camera = ToCamera(v);
  rig.T_body_camera = ToBodyCamera(v);
  if (v.Has("timeshift_cam_imu")) {
    const double shift = v.Number("timeshift_cam_imu");
    if (!(std::abs(shift) < 1))
      v.Fail("timeshift_cam_imu", "is " + std::to_string(shift) + " s; expected less than a second");
    rig.camera_time_offset = std::llround(1e6 * shift);
  }
  rig.imu_noise = kConsumerImuNoise;
  rig.imu_rate_hz = 200;
  if (!parts.imu.empty()) ReadImu(parts.imu, &rig);
  return rig;
}

std::string KalibrRigName(const std::string& path) {
  const Parts parts = PartsOf(path);
  return parts.camera + " of " + parts.chain + ", " +
         (parts.imu.empty() ? "no IMU file: noise of a consumer IMU at 200 Hz is assumed (give CAMCHAIN,IMU)"
                            : "IMU of " + parts.imu);
}

}  // namespace evit
