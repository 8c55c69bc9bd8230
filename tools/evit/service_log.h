#pragma once

#include <sys/types.h>

#include <string>

namespace evit::commands {

/// The file that the output of command `id` goes to, of the deputy (`evit run`, `evit up`) that started
/// process `pid` on this host, as the kernel knows the deputy's open files. Empty where there is none: it
/// runs on another host, in a container or for another user.
std::string LogFileOfCommand(pid_t pid, const std::string& id);

}  // namespace evit::commands
