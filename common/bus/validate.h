#pragma once

#include <string>

#include "evit/messages.hpp"

/// The meaning of fields, once a message is decoded: finite numbers, unit quaternions (within 1e-3), sorted
/// times, sizes that agree, enumerations within their range. False, with the reason in `why` (may be null),
/// where it is wrong.
namespace evit {

#define EVIT_DECLARE(MESSAGE) bool Validate(const MESSAGE& m, std::string* why);
EVIT_MESSAGES(EVIT_DECLARE)
#undef EVIT_DECLARE

}  // namespace evit
