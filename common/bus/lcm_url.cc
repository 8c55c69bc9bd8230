#include "common/bus/lcm_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace evit {

namespace {

constexpr char kScheme[] = "udpm://";
constexpr char kBufferKey[] = "recv_buf_size=";

int ParseInt(const std::string& url, const std::string& part, const std::string& text, int low, int high) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || value < low || value > high) {
    throw std::runtime_error("LCM URL \"" + url + "\": " + part + " \"" + text + "\" is not a number from " +
                             std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

class Socket {
 public:
  Socket() : fd_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "cannot make a UDP socket");
  }
  ~Socket() { ::close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

LcmUrl ParseLcmUrl(const std::string& url) {
  LcmUrl result;
  if (url.rfind(kScheme, 0) != 0) return result;
  result.multicast = true;
  const std::string rest = url.substr(std::strlen(kScheme));
  const std::string address = rest.substr(0, rest.find('?'));
  const std::size_t colon = address.find(':');
  if (!address.substr(0, colon).empty()) result.group = address.substr(0, colon);
  if (colon != std::string::npos) result.port = ParseInt(url, "port", address.substr(colon + 1), 1, 65535);
  in_addr group{};
  if (::inet_pton(AF_INET, result.group.c_str(), &group) != 1 || !IN_MULTICAST(ntohl(group.s_addr))) {
    throw std::runtime_error("LCM URL \"" + url + "\": \"" + result.group +
                             "\" is not an IPv4 multicast address (224.0.0.0 to 239.255.255.255)");
  }
  const std::size_t key = rest.find(kBufferKey);
  if (key != std::string::npos) {
    const std::size_t begin = key + std::strlen(kBufferKey);
    const std::string value = rest.substr(begin, rest.find_first_of("&?", begin) - begin);
    result.receive_buffer = ParseInt(url, "recv_buf_size", value, 1, 1 << 30);
  }
  return result;
}

std::string WithReceiveBuffer(const std::string& url, int bytes) {
  std::string result = url;
  const std::size_t key = result.find(kBufferKey);
  if (key != std::string::npos) {
    const std::size_t end = result.find_first_of("&?", key);
    return result.replace(key, end == std::string::npos ? end : end - key,
                          kBufferKey + std::to_string(bytes));
  }
  const char separator = result.find('?') == std::string::npos ? '?' : '&';
  return result + separator + kBufferKey + std::to_string(bytes);
}

int ProbeReceiveBuffer(int bytes) {
  const Socket socket;
  // Refused or clamped, what counts is what is there afterwards.
  (void)::setsockopt(socket.fd(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  int granted = 0;
  socklen_t length = sizeof(granted);
  if (::getsockopt(socket.fd(), SOL_SOCKET, SO_RCVBUF, &granted, &length) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot read the receive buffer's size");
  }
  return granted / 2;
}

void RequireMulticastRoute(const LcmUrl& url) {
  const Socket socket;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(url.port));
  ::inet_pton(AF_INET, url.group.c_str(), &address.sin_addr);
  // connect() on UDP sends nothing: it only looks the route up.
  if (::connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return;
  throw std::runtime_error("no route to the LCM multicast group " + url.group + " (" + std::strerror(errno) +
                           "). Give this host one, without sending anything to the network: "
                           "ip link set lo up && ip route add " +
                           url.group + "/32 dev lo; or run inside scripts/in-netns");
}

}  // namespace evit
