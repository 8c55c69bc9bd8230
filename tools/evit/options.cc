#include "tools/evit/options.h"

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace evit {

std::pair<double, double> ParseSeconds(const std::string& text) {
  double a = 0, b = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf:%lf%c", &a, &b, &rest) != 2 || !(a >= 0 && b > a)) {
    throw std::runtime_error("--seconds " + text + ": A:B is wanted, with 0 <= A < B");
  }
  return {a, b};
}

SE3 ParseTransform(const std::string& option, const std::string& text) {
  std::istringstream words(text);
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m;
  for (int k = 0; k < 16; ++k) {
    if (!(words >> m.data()[k]))
      throw std::runtime_error(option + ": 16 numbers are wanted (4x4, row-major)");
  }
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 || R.determinant() < 0) {
    throw std::runtime_error(option + ": the upper left 3x3 is not a rotation");
  }
  return SE3(Eigen::Matrix4d(m));
}

SE3 ParsePose(const std::string& option, const std::string& text) {
  double v[7];
  char rest = 0;
  const int n = std::sscanf(text.c_str(), " %lf %lf %lf %lf %lf %lf %lf %c", v, v + 1, v + 2, v + 3, v + 4,
                            v + 5, v + 6, &rest);
  if (n != 7 || !(std::abs(Eigen::Quaterniond(v[6], v[3], v[4], v[5]).norm() - 1) < 1e-2)) {
    throw std::runtime_error(option + " \"" + text +
                             "\": seven numbers are wanted, x y z (m) and a unit quaternion qx qy qz qw");
  }
  return {Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized(), {v[0], v[1], v[2]}};
}

std::string CommandLineOfThis() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string line;
  for (std::string word; std::getline(file, word, '\0');) {
    const bool plain = !word.empty() && word.find_first_of(" \t\n\"'$*?;&|<>()\\") == std::string::npos;
    line += (line.empty() ? "" : " ") + (plain ? word : "\"" + word + "\"");
  }
  return line;
}

std::string ConfigFile(const std::string& name) {
  const std::filesystem::path beside =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../config" / name;
  if (std::filesystem::exists(beside)) return beside.lexically_normal().string();
  return std::string(EVIT_PROJECT_DIR) + "/config/" + name;
}

}  // namespace evit
