#pragma once

#include <string>
#include <vector>

namespace evit {

/// Sockets of this process for UDP over IPv4 that are bound to `port`.
std::vector<int> SocketsOnPort(int port);

/// Has the kernel drop what a socket receives of LCM's UDP messages on other channels than these, before it
/// is copied or wakes anybody: all processes on a multicast group are sent all messages, and most of them
/// want no events. Of a message in several datagrams only the first names its channel; the others pass, and
/// LCM drops them. What is not an LCM message passes, too. Called again it replaces the channels.
///
/// False where the kernel does not do that (too many channels, a sandbox): then everything passes.
bool HearOnlyChannels(int socket, const std::vector<std::string>& channels);

}  // namespace evit
