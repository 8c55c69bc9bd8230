#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace evit::bench {

/// Draws where the CPU time of one keyframe goes, all processes together, from a report of `evit run`. Throws
/// std::runtime_error where `png` cannot be written or the report holds no keyframe.
void DrawStages(const nlohmann::json& report, const std::string& png);

}  // namespace evit::bench
