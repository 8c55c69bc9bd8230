#include "tools/formats/calibration_files/dsec_calibration.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "common/config/kalibr_file.h"
#include "common/files/table_reader.h"

namespace evit::formats {
namespace {

using Yaml = std::map<std::string, std::vector<std::string>>;
constexpr std::size_t kMaxSize = 1 << 20;  // bytes; such files have a few thousand

Yaml Load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxSize, '\0');
  if (!file || (file.read(text.data(), kMaxSize), file.bad()))
    throw std::runtime_error(path + ": cannot be read; is the path right?");
  text.resize(static_cast<std::size_t>(file.gcount()));
  return ParseSimpleYaml(text, path);
}

std::vector<double> Numbers(const Yaml& yaml, const std::string& path, const std::string& key,
                            std::size_t n) {
  const auto found = yaml.find(key);
  if (found == yaml.end()) throw std::runtime_error(path + ": " + key + " is missing");
  std::vector<double> numbers(found->second.size());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (!ParseNumber(found->second[k], &numbers[k]))
      throw std::runtime_error(path + ": " + key + ": " + found->second[k] + " is not a number");
  }
  if (numbers.size() != n) {
    throw std::runtime_error(path + ": " + key + " has " + std::to_string(numbers.size()) +
                             " numbers, expected " + std::to_string(n));
  }
  return numbers;
}

}  // namespace

bool IsDsecCalibration(const std::string& path) {
  return Load(path).count("intrinsics.cam0.camera_matrix") > 0;
}

Rig ReadDsecCalibration(const std::string& path, const std::string& side) {
  const Yaml yaml = Load(path);
  const std::string camera = side == "right" ? "intrinsics.cam3." : "intrinsics.cam0.";
  Rig rig;
  const auto model = yaml.find(camera + "distortion_model");
  const std::string name = model == yaml.end() || model->second.size() != 1 ? "radtan" : model->second[0];
  if (!CameraModelFromName(name, &rig.camera.model))
    throw std::runtime_error(path + ": " + camera + "distortion_model is \"" + name + "\"; expected radtan");
  const std::vector<double> f = Numbers(yaml, path, camera + "camera_matrix", 4),
                            d = Numbers(yaml, path, camera + "distortion_coeffs", 4),
                            size = Numbers(yaml, path, camera + "resolution", 2);
  if (!(f[0] > 0 && f[1] > 0 && size[0] >= 16 && size[1] >= 16 && size[0] <= 8192 && size[1] <= 8192))
    throw std::runtime_error(path + ": " + camera + "camera_matrix or resolution makes no camera");
  rig.camera.width = static_cast<int>(size[0]);
  rig.camera.height = static_cast<int>(size[1]);
  rig.camera.fx = f[0], rig.camera.fy = f[1], rig.camera.cx = f[2], rig.camera.cy = f[3];
  std::copy(d.begin(), d.end(), rig.camera.distortion.begin());
  return rig;
}

}  // namespace evit::formats
