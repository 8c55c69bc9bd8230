#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/helpers/doctor_sample.h"

namespace evit::doctor {

struct Fault {
  std::string name;
  std::string check;  // what has to be named first or second
  std::function<void(Sample*)> make;
  std::function<bool(const Sample&)> applies{};  // where it is one, and can show; empty: everywhere
};
/// All of the lists below.
std::vector<Fault> Faults();
/// Of the sensor, its events and their stamps.
std::vector<Fault> EventFaults();
/// Of the IMU and its clock.
std::vector<Fault> ImuFaults();
/// Of rig file, known poses, start and map, and of the camera's clock against the poses.
std::vector<Fault> PlaceFaults();

/// Whether any of `checks` is named first or second; `said` as below.
bool IsNamed(const std::vector<std::string>& checks, const diagnosis::Findings& findings, std::string* said);
/// Whether the doctor names the fault first or second; `said`: what it says of a sick sample, a line each.
bool IsNamed(const Fault& fault, const diagnosis::Findings& findings, std::string* said);

}  // namespace evit::doctor
