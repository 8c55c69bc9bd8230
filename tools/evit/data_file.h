#pragma once

#include <string>

namespace evit::commands {

/// The absolute path of a file that comes with EVIT, e.g. "config/tracker.textproto". It is looked for in
/// share/evit beside the running program's bin/: where EVIT is installed, or in a build tree, whose
/// share/evit is a link to the sources. Throws std::runtime_error where it is missing.
std::string DataFile(const std::string& name);

}  // namespace evit::commands
