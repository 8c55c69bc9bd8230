#pragma once

#include <string>

#include "tools/run/run_file.h"

namespace evit::run {

/// Makes sure UDP multicast works on `lo` without ever leaving the host. Where the machine's `lo` has a route
/// to the group of `url` nothing is done; otherwise this process (and all children it starts later) moves
/// into a network namespace of its own, in which `lo` is up and carries multicast. No privileges needed. Call
/// before any thread or socket is made. Returns whether a namespace was made. Throws std::runtime_error with
/// the remedy where the kernel forbids it.
bool EnsureLocalMulticast(const std::string& url);

/// Whether neither the option --lcm-url (empty: not given) nor the environment chooses a bus, so that it is
/// the one that never leaves this host.
bool IsLocalBus(const std::string& lcm_url);

/// Moves this process into the network namespace of a running pipeline. Call before any thread or socket is
/// made. Throws std::runtime_error where the kernel forbids it.
void JoinNetworkOf(const RunningPipeline& pipeline);

/// Whether this process might: not where the pipeline belongs to somebody else, or runs in a container. Tried
/// by a child, so that nothing changes here.
bool CanJoinNetworkOf(const RunningPipeline& pipeline);

}  // namespace evit::run
