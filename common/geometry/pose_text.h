#pragma once

#include <string>

#include "common/geometry/se3.h"

namespace evit {

/// A pose as people type it: "x y z qx qy qz qw", position in m and a unit quaternion (to 1 %; normalised
/// here). `option` is what the text was given for; throws std::runtime_error naming it, the text and what
/// was expected.
SE3 ParsePose(const std::string& option, const std::string& text);

}  // namespace evit
