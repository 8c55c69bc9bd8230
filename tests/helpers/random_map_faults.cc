// Faults of the map: unit, scale, frame, gravity, another place, holes.
#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/so3.h"
#include "common/text/format_text.h"
#include "tests/helpers/random_faults.h"

namespace evit::doctor {
namespace {

void TransformMap(Sample* s, const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  for (Eigen::Vector3f& p : s->map.points) p = (R * p.cast<double>() + t).cast<float>();
}

std::string MapUnit(Sample* s, Chance* chance) {
  const std::array<std::pair<const char*, double>, 5> units{
      {{"mm", 1000}, {"cm", 100}, {"feet", 3.28084}, {"inches", 39.37}, {"km", 0.001}}};
  const auto& [name, factor] = units[static_cast<std::size_t>(Pick(chance, 5))];
  TransformMap(s, factor * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  return FormatText("map in %s", name);
}

// Seen from one place, a larger room looks the same.
bool Travels(const Sample& s) {
  Eigen::Vector3d low = s.truth.front().pose.p, high = low;
  for (const StampedPose& p : s.truth) low = low.cwiseMin(p.pose.p), high = high.cwiseMax(p.pose.p);
  return (high - low).norm() > 0.2;
}

std::string MapScale(Sample* s, Chance* chance) {
  if (!Travels(*s)) return "";
  const double off = Either(chance, -1, 1) * Draw(chance, 0.05, 0.25);
  TransformMap(s, (1 + off) * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  return FormatText("map %+.0f %%", 100 * off);
}

std::string MapFrame(Sample* s, Chance* chance) {
  const int what = Pick(chance, 4);
  const double yaw = Draw(chance, 0.1, 3.1), metres = what == 1 ? Draw(chance, 0.15, 3) : Draw(chance, 5, 50);
  const Eigen::Vector3d by = metres * DrawDirection(chance);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (what == 0) R = ExpSO3({0, 0, yaw}).toRotationMatrix();
  if (what == 3) R = Eigen::Vector3d(1, -1, 1).asDiagonal();
  TransformMap(s, R, what == 1 || what == 2 ? by : Eigen::Vector3d::Zero());
  return what == 0   ? FormatText("map turned by %.0f deg about the vertical", yaw * 180 / M_PI)
         : what == 3 ? "map mirrored"
                     : FormatText("map moved by %.1f m", metres);
}

// z is not up: of the map alone, or of map and truth.
std::string MapGravity(Sample* s, Chance* chance) {
  const bool both = Pick(chance, 2) == 0, right = Pick(chance, 2) == 0;
  const double angle = right ? M_PI / 2 : Draw(chance, 0.14, 0.6);
  const Eigen::Vector3d axis = Eigen::Vector3d(Draw(chance, -1, 1), Draw(chance, -1, 1), 0).normalized();
  const SE3 turn(ExpSO3(angle * axis), Eigen::Vector3d::Zero());
  TransformMap(s, turn.q.toRotationMatrix(), Eigen::Vector3d::Zero());
  if (both)
    for (StampedPose& p : s->truth) p.pose = turn * p.pose;
  return FormatText("%s tilted by %.0f deg", both ? "map and truth" : "map", angle * 180 / M_PI);
}

// Its points anywhere in the same box, or pieces of it elsewhere: another place.
std::string OtherPlace(Sample* s, Chance* chance) {
  Eigen::Vector3f low = s->map.points.front(), high = low;
  for (const Eigen::Vector3f& p : s->map.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const bool anywhere = Pick(chance, 2) == 0;
  for (Eigen::Vector3f& p : s->map.points) {
    if (anywhere) {
      for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(Draw(chance, low[k], high[k]));
    } else {  // front and back, left and right change places
      p.head<2>() = (low + high).head<2>() - p.head<2>();
      std::swap(p.x(), p.y());
    }
  }
  return anywhere ? "map of points anywhere" : "map of another place";
}

// On one side of a plane along the optical axis in the middle of the recording, or one half in depth.
std::string MapHoles(Sample* s, Chance* chance) {
  const SE3 T_camera_map = (s->truth[s->truth.size() / 2].pose * s->rig.T_body_camera).Inverse();
  const double angle = Draw(chance, 0, 2 * M_PI);
  const Eigen::Vector3d side(std::cos(angle), std::sin(angle), 0);
  std::vector<Eigen::Vector3f>& points = s->map.points;
  points.erase(
      std::remove_if(points.begin(), points.end(),
                     [&](const Eigen::Vector3f& p) { return side.dot(T_camera_map * p.cast<double>()) > 0; }),
      points.end());
  return FormatText("half of the map missing, towards %.0f deg", angle * 180 / M_PI);
}

std::string ThinMap(Sample* s, Chance* chance) {
  std::vector<Eigen::Vector3f>& points = s->map.points;
  std::shuffle(points.begin(), points.end(), *chance);
  points.resize(20 + static_cast<std::size_t>(Pick(chance, 380)));
  return FormatText("a map of %zu points", points.size());
}

}  // namespace

std::vector<RandomFault> RandomMapFaults() {
  return {{"map's unit", {"map-unit"}, MapUnit},
          {"map's scale", {"map-scale"}, MapScale},
          {"map's frame", {"map-overlap"}, MapFrame},
          {"map's gravity", {"gravity", "map-overlap"}, MapGravity},
          {"another place", {"map-overlap"}, OtherPlace},
          {"holes of the map", {"map-holes"}, MapHoles},
          {"few map points", {"map-size", "map-spacing"}, ThinMap}};
}

}  // namespace evit::doctor
