#include "common/evaluation/covariance_file.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "common/files/table_reader.h"
#include "common/files/whole_file.h"

namespace evit {

Covariances ReadCovariances(const std::string& path) {
  TableReader rows(path, "utime and the 21 numbers of the upper triangle of a 6x6 matrix");
  Covariances all;
  while (rows.Next()) {
    StampedCovariance row;
    row.t = rows.Integer();
    for (int r = 0; r < 6; ++r) {
      for (int c = r; c < 6; ++c) row.covariance(r, c) = row.covariance(c, r) = rows.Finite();
    }
    rows.End();
    if (!all.empty() && row.t <= all.back().t) rows.Fail("the time does not increase");
    all.push_back(row);
  }
  if (all.empty())
    throw std::runtime_error(path + ": contains no covariance; expected covariance.csv of evit run");
  return all;
}

void WriteCovariances(const std::string& path, const Covariances& covariances) {
  WholeFile whole(path);
  std::ofstream& file = whole.stream();
  file << "# utime[us], upper triangle of the pose's covariance row by row: position x y z [m, map frame], "
          "rotation x y z [rad, right perturbation, body frame]; poses without one are left out\n";
  for (const StampedCovariance& s : covariances) {
    if (s.covariance.isZero(0)) continue;
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
  whole.Commit();
}

}  // namespace evit
