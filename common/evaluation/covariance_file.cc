#include "common/evaluation/covariance_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace evit {

Covariances ReadCovariances(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error(path + ": cannot be read; the covariance.csv of an `evit run` is wanted");
  }
  Covariances all;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto fail = [&](const char* what) {
      throw std::runtime_error(
          std::string(path).append(":").append(std::to_string(number)).append(": ").append(what));
    };
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string first;
    if (!(words >> first) || first[0] == '#') continue;
    std::istringstream stamp(first);
    StampedCovariance row;
    if (!(stamp >> row.t) || stamp.peek() != std::istringstream::traits_type::eof()) {
      fail("the first field is no time in whole microseconds");
    }
    for (int r = 0; r < 6; ++r) {
      for (int c = r; c < 6; ++c) {
        double value = 0;
        if (!(words >> value)) fail("22 numbers are wanted: utime and the upper triangle of a 6x6 matrix");
        if (!std::isfinite(value)) fail("a value is not finite");
        row.covariance(r, c) = row.covariance(c, r) = value;
      }
    }
    if (words >> first) fail("there are more than 22 numbers");
    if (!all.empty() && row.t <= all.back().t) fail("the time does not increase");
    all.push_back(row);
  }
  if (all.empty()) throw std::runtime_error(path + ": holds no covariance");
  return all;
}

void WriteCovariances(const std::string& path, const Covariances& covariances) {
  const std::string part = path + ".part";
  std::ofstream file(part);
  file << "# utime[us], upper triangle of the pose's covariance row by row: position x y z [m, map frame], "
          "rotation x y z [rad, right perturbation, body frame]; zeros: none given\n";
  for (const StampedCovariance& s : covariances) {
    file << s.t;
    for (int r = 0; r < 6; ++r) {
      for (int c = r; c < 6; ++c) {
        char text[32];
        std::snprintf(text, sizeof text, ",%.9g", s.covariance(r, c));
        file << text;
      }
    }
    file << '\n';
  }
  file.close();
  if (!file || std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw std::runtime_error(path +
                             ": cannot be written; check that the folder exists, is writable and has room");
  }
}

}  // namespace evit
