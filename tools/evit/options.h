#pragma once

#include <string>
#include <utility>

#include "common/evaluation/trajectory.h"
#include "common/geometry/se3.h"

/// Forms of option values that several subcommands share. Each throws std::runtime_error naming the option.
namespace evit::commands {

/// "A:B" in seconds, A < B.
std::pair<double, double> ParseSeconds(const std::string& text);

/// "WxH" of a sensor, 16 to 8192 pixels each, for --size.
void ParseSize(const std::string& text, int* width, int* height);

/// 16 numbers, row-major 4x4, a rigid transformation.
SE3 ParseTransform(const std::string& option, const std::string& text);

/// A trajectory from a TUM file; rows that were passed over are told on standard error.
Trajectory ReadTrajectory(const std::string& path);

/// This process's command line, as it could be typed again.
std::string CommandLineOfThis();

}  // namespace evit::commands
