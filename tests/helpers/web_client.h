#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace evit::test {

/// For tests: a WebSocket client on a bare socket that never waits, so that it can do what no browser would.
class WebClient {
 public:
  explicit WebClient(int port) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
    // A small buffer: a client that does not read is noticed soon.
    const int small = 4096;
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    fcntl(fd_, F_SETFL, O_NONBLOCK);
  }
  ~WebClient() { close(fd_); }
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  bool connected() const { return connected_; }
  bool closed() const { return closed_; }

  void SendRaw(const std::string& bytes) { (void)!send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  void Upgrade(const std::string& host, const std::string& origin, const std::string& protocol) {
    SendRaw("GET / HTTP/1.1\r\nHost: " + host + "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n" +
            (origin.empty() ? "" : "Origin: " + origin + "\r\n") + "Sec-WebSocket-Protocol: " + protocol +
            "\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  }
  /// A text frame, whole, masked with zeros.
  void SendText(const std::string& text) {
    std::string head = "\x81";
    if (text.size() < 126) {
      head += static_cast<char>(0x80 | text.size());
    } else {
      head += static_cast<char>(0x80 | 127);
      for (int shift = 56; shift >= 0; shift -= 8) head += static_cast<char>(text.size() >> shift & 255);
    }
    SendRaw(head + std::string(4, '\0') + text);
  }

  /// Takes in what has come.
  void Read() {
    char buffer[65536];
    ssize_t n = 0;
    while ((n = recv(fd_, buffer, sizeof buffer, 0)) > 0)
      received_.append(buffer, static_cast<std::size_t>(n));
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK)) closed_ = true;
  }
  /// The answer's head, once it has come.
  std::optional<std::string> Head() {
    const std::size_t end = received_.find("\r\n\r\n");
    if (end == std::string::npos) return std::nullopt;
    const std::string head = received_.substr(0, end);
    received_.erase(0, end + 4);
    return head;
  }
  /// The payload of the next frame, once it has come whole.
  std::optional<std::string> Frame() {
    if (received_.size() < 2) return std::nullopt;
    const auto byte = [this](std::size_t i) { return static_cast<std::uint8_t>(received_[i]); };
    std::size_t size = byte(1) & 127U, head = 2;
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (received_.size() < head + more) return std::nullopt;
    if (more > 0) size = 0;
    for (; head < 2 + more; ++head) size = size << 8 | byte(head);
    if (received_.size() < head + size) return std::nullopt;
    std::string payload = received_.substr(head, size);
    received_.erase(0, head + size);
    return payload;
  }

 private:
  int fd_;
  bool connected_ = false, closed_ = false;
  std::string received_;
};

}  // namespace evit::test
