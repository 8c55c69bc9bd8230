#include "tools/evit/options.h"

#include <Eigen/LU>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace evit::commands {
namespace {

constexpr double kLongest = 1e9;  // s, thirty years: microseconds fit into 64 bits

}  // namespace

std::pair<double, double> ParseSeconds(const std::string& text) {
  double a = 0, b = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf:%lf%c", &a, &b, &rest) != 2 || !(a >= 0 && b > a && b <= kLongest)) {
    throw std::runtime_error("--seconds \"" + text + "\": expected A:B with 0 <= A < B, in seconds");
  }
  return {a, b};
}

void ParseSize(const std::string& text, int* width, int* height) {
  char rest = 0;
  const int n = std::sscanf(text.c_str(), "%dx%d%c", width, height, &rest);
  const auto possible = [](int pixels) { return pixels >= 16 && pixels <= 8192; };
  if (n != 2 || !possible(*width) || !possible(*height))
    throw std::runtime_error("--size " + text + ": expected WxH, 16 to 8192 pixels each, e.g. 346x260");
}

SE3 ParseTransform(const std::string& option, const std::string& text) {
  std::istringstream words(text);
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m;
  for (int k = 0; k < 16; ++k) {
    if (!(words >> m.data()[k])) throw std::runtime_error(option + ": expected 16 numbers (4x4, row-major)");
  }
  if (std::string more; words >> more)
    throw std::runtime_error(option + ": expected 16 numbers (4x4, row-major), and no more: " + more);
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 || R.determinant() < 0) {
    throw std::runtime_error(option + ": the upper left 3x3 is not a rotation");
  }
  return SE3(Eigen::Matrix4d(m));
}

Trajectory ReadTrajectory(const std::string& path) {
  TumSkipped skipped;
  Trajectory trajectory = ReadTum(path, &skipped);
  if (skipped.rows > 0) std::fprintf(stderr, "note: %s\n", skipped.Text(path).c_str());
  return trajectory;
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

}  // namespace evit::commands
