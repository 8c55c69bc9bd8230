#include "common/bus/udp_receiver.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "common/bus/channel_filter.h"

namespace evit {
namespace {

constexpr std::size_t kLargestDatagram = 65536;  // bytes

template <typename Value>
bool Set(int socket, int level, int name, const Value& value) {
  return ::setsockopt(socket, level, name, &value, sizeof value) == 0;
}

bool Join(int socket, const LcmUrl& url) {
  const int yes = 1, no = 0;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(static_cast<std::uint16_t>(url.port));
  ip_mreq group{};
  group.imr_interface.s_addr = htonl(INADDR_ANY);
  if (::inet_pton(AF_INET, url.group.c_str(), &group.imr_multiaddr) != 1) return false;
  if (!Set(socket, SOL_SOCKET, SO_REUSEADDR, yes)) return false;  // every process binds the same port
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return false;
  // Else Linux hands us every group of the port (ip(7)).
  (void)Set(socket, IPPROTO_IP, IP_MULTICAST_ALL, no);
  return Set(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, group);
}

}  // namespace

UdpReceiver::UdpReceiver(const LcmUrl& url, int receive_buffer)
    : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)), datagram_(kLargestDatagram) {
  (void)Set(socket_, SOL_SOCKET, SO_RCVBUF, receive_buffer);
  if (socket_ >= 0 && Join(socket_, url)) return;
  const std::string why = std::strerror(errno);
  if (socket_ >= 0) ::close(socket_);
  throw std::runtime_error("cannot join the LCM multicast group " + url.group + ":" +
                           std::to_string(url.port) + ": " + why);
}

UdpReceiver::~UdpReceiver() { ::close(socket_); }

void UdpReceiver::Hear(const std::vector<std::string>& channels) {
  (void)HearOnlyChannels(socket_, channels);  // without it what is not subscribed is dropped later
}

bool UdpReceiver::Wait(int timeout_ms) const {
  pollfd wait{socket_, POLLIN, 0};
  return ::poll(&wait, 1, timeout_ms) > 0;
}

bool UdpReceiver::Read(MessageAssembler::Message* message) {
  sockaddr_in from{};
  while (true) {
    socklen_t length = sizeof from;
    const ssize_t n = ::recvfrom(socket_, datagram_.data(), datagram_.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&from), &length);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    const std::uint64_t sender = std::uint64_t{from.sin_addr.s_addr} << 16 | from.sin_port;
    if (assembler_.Add(sender, datagram_.data(), static_cast<std::size_t>(n), message)) return true;
  }
}

void UdpReceiver::ExchangeMemory(const MessageAssembler::Message& message, std::vector<std::uint8_t>* memory,
                                 std::size_t* begin) {
  if (message.fragmented) {
    *begin = 0;
    assembler_.ExchangeMemory(memory);
    return;
  }
  *begin = static_cast<std::size_t>(message.data - datagram_.data());
  if (memory->size() < kLargestDatagram) memory->resize(kLargestDatagram);
  memory->swap(datagram_);
}

}  // namespace evit
