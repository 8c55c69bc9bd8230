#pragma once

#include <string>

#include "procman/deployment.h"

namespace evit::commands {

/// Before anything starts: a service that cannot read its file would die and be started again for ever.
/// Throws std::runtime_error where EVIT_MAP, EVIT_RIG, EVIT_CONFIG or EVIT_LOG names no file and a command of
/// `deputy` that `script` starts uses it, and where such a command uses a variable that is not set.
void RequireFiles(const procman::Deployment& deployment, const std::string& script,
                  const std::string& deputy);

}  // namespace evit::commands
