#include "common/bus/lcm_url.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "common/bus/channel_filter.h"

namespace evit {

namespace {

constexpr char kScheme[] = "udpm://", kServerScheme[] = "tcpq://";
constexpr int kServerPatience = 2000;  // ms
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

// "KEY=VALUE&..." of a udpm URL. liblcm would take "ttl=abc" for 0, and only warn of a key it does not know.
void ParseOptions(const std::string& url, const std::string& options, LcmUrl* result) {
  for (std::size_t begin = 0, end = 0; begin < options.size(); begin = end + 1) {
    end = std::min(options.find('&', begin), options.size());
    const std::string option = options.substr(begin, end - begin);
    const std::string key = option.substr(0, option.find('='));
    const std::string value = option.substr(std::min(key.size() + 1, option.size()));
    if (key == "ttl") {
      (void)ParseInt(url, key, value, 0, 255);
    } else if (key == "recv_buf_size") {
      result->receive_buffer = ParseInt(url, key, value, 1, 1 << 30);
    } else if (!option.empty() && key != "transmit_only") {  // obsolete: liblcm only says so
      std::string text = "LCM URL \"";
      text.append(url).append("\": \"").append(key);
      throw std::runtime_error(text.append("\" is no option of udpm; it has ttl and recv_buf_size"));
    }
  }
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
  if (url.rfind(kServerScheme, 0) == 0) {
    result.server = true;
    result.port = 7700;
    const std::string address =
        url.substr(std::strlen(kServerScheme), url.find('?') - std::strlen(kServerScheme));
    const std::size_t colon = address.find(':');
    if (!address.substr(0, colon).empty()) result.host = address.substr(0, colon);
    if (colon != std::string::npos) result.port = ParseInt(url, "port", address.substr(colon + 1), 1, 65535);
    return result;
  }
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
  if (address.size() < rest.size()) ParseOptions(url, rest.substr(address.size() + 1), &result);
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

void RequireSharedBus(const std::string& url) {
  for (const char* kind : {"memq://", "file://"}) {
    if (url.rfind(kind, 0) != 0) continue;
    throw std::runtime_error(
        "LCM URL \"" + url + "\": " + kind +
        " reaches no other process; give udpm://239.255.76.67:7667?ttl=0, or tcpq://HOST:PORT "
        "with a running lcm-tcpq server");
  }
}

void RequireServer(const LcmUrl& url) {
  const std::string where = url.host + ":" + std::to_string(url.port);
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  if (::getaddrinfo(url.host.c_str(), std::to_string(url.port).c_str(), &hints, &found) != 0)
    throw std::runtime_error("tcpq: the host of " + where + " is not known; check --lcm-url");
  std::string why = "no answer";
  bool there = false;
  for (const addrinfo* a = found; a != nullptr && !there; a = a->ai_next) {
    const int fd = ::socket(a->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0) continue;
    int error = ::connect(fd, a->ai_addr, a->ai_addrlen) == 0 ? 0 : errno;
    pollfd wait{fd, POLLOUT, 0};
    socklen_t size = sizeof error;
    if (error == EINPROGRESS) {
      error = ::poll(&wait, 1, kServerPatience) > 0 ? 0 : ETIMEDOUT;
      if (error == 0) ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
    }
    there = error == 0;
    if (!there) why = std::strerror(error);
    ::close(fd);
  }
  ::freeaddrinfo(found);
  if (!there) {
    throw std::runtime_error(
        "tcpq: no server at " + where + " (" + why +
        "); start one there (java -cp lcm.jar lcm.lcm.TCPService), or give a udpm:// URL");
  }
}

void HearOnlyOwnGroup(const LcmUrl& url) {
  for (const int fd : SocketsOnPort(url.port)) {
    const int no = 0;
    (void)::setsockopt(fd, IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no);  // Linux 2.6.31; else as before
  }
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
