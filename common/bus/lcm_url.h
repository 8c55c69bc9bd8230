#pragma once

#include <string>

namespace evit {

/// Receive buffer that is asked for where the URL names none, bytes: no loss up to 10 million events/s, where
/// the kernel's default loses.
inline constexpr int kDefaultReceiveBuffer = 4 << 20;

/// What is in an LCM URL of the kind udpm://GROUP:PORT?ttl=T&recv_buf_size=B or tcpq://HOST:PORT.
struct LcmUrl {
  bool multicast = false;  // udpm
  bool server = false;     // tcpq: through a server; group and receive_buffer are not set
  std::string group = "239.255.76.67";
  std::string host = "127.0.0.1";
  int port = 7667;         // of a server: 7700
  int receive_buffer = 0;  // bytes asked for in the URL; 0: none
};

/// Throws std::runtime_error, naming the part, where a udpm URL is malformed, the group is not a multicast
/// address or an option has another value or name than liblcm takes.
LcmUrl ParseLcmUrl(const std::string& url);

/// The same URL with recv_buf_size set to `bytes`, replacing what it says.
std::string WithReceiveBuffer(const std::string& url, int bytes);

/// What the kernel grants a UDP socket of this process that asks for a receive buffer of `bytes`. LCM's own
/// socket is out of reach (lcm_get_fileno is only a notification pipe), but SO_RCVBUF is granted by one rule
/// for every socket, min(asked, net.core.rmem_max), and LCM asks as this does: so a socket of our own reads
/// the same number. Half of what getsockopt says, which is doubled for the kernel's book-keeping.
int ProbeReceiveBuffer(int bytes);

/// Throws std::runtime_error with the remedy where the URL is of a kind that reaches no other process (memq,
/// file).
void RequireSharedBus(const std::string& url);

/// Throws std::runtime_error with the remedy where no tcpq server answers at the URL within two seconds:
/// liblcm would end the process.
void RequireServer(const LcmUrl& url);

/// Makes the sockets of this process that are bound to the URL's port hear the groups they joined, and no
/// other: Linux hands every group of a port to all of its sockets, whoever joined it (ip(7),
/// IP_MULTICAST_ALL), so another group on the same port would mix with ours.
void HearOnlyOwnGroup(const LcmUrl& url);

/// Throws std::runtime_error with the remedy where this host has no route to the multicast group.
void RequireMulticastRoute(const LcmUrl& url);

}  // namespace evit
