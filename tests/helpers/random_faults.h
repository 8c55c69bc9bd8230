#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/helpers/doctor_sample.h"

namespace evit::doctor {

using Chance = std::mt19937;

/// A kind of fault that is another each time: what it does, how much, where and when are drawn by chance.
struct RandomFault {
  std::string kind;                 // for a table
  std::vector<std::string> checks;  // any of them names it
  /// Puts one into a sample and says which; empty where this sample cannot have it.
  std::function<std::string(Sample*, Chance*)> make;
};

/// All of the kinds below.
std::vector<RandomFault> RandomFaults();
/// Of events and their stamps.
std::vector<RandomFault> RandomEventFaults();
/// Of the IMU and its clock.
std::vector<RandomFault> RandomImuFaults();
/// Of the rig file, of known poses and of the start.
std::vector<RandomFault> RandomRigFaults();
/// Of the map.
std::vector<RandomFault> RandomMapFaults();

/// Uniform in [low, high).
double Draw(Chance* chance, double low, double high);
/// One of 0 .. n - 1.
int Pick(Chance* chance, int n);
/// low or high, as likely.
double Either(Chance* chance, double low, double high);
/// A direction, uniform on the sphere.
Eigen::Vector3d DrawDirection(Chance* chance);

}  // namespace evit::doctor
