#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <regex>
#include <string>
#include <thread>
#include <vector>

namespace evit::test {

/// A server of LCM's tcpq provider (one message: type, length of the channel, channel, length, bytes; words
/// in network order) on a free port of this host, until Stop(): then all its connections are gone.
class TcpqServer {
 public:
  TcpqServer() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 64) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      return;
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Serve(); });
  }
  ~TcpqServer() { Stop(); }
  TcpqServer(const TcpqServer&) = delete;
  TcpqServer& operator=(const TcpqServer&) = delete;

  int port() const { return port_; }  // 0: could not listen
  std::int64_t n_messages() const { return n_messages_; }
  void Stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    for (const Client& client : clients_) ::close(client.fd);
    clients_.clear();
    if (listener_ >= 0) ::close(listener_);
    listener_ = -1;
  }

 private:
  enum Type : std::uint32_t { kPublish = 1, kSubscribe = 2, kUnsubscribe = 3 };
  struct Client {
    int fd;
    bool greeted = false;
    std::string in;
    std::vector<std::string> channels;  // regular expressions
  };

  static std::uint32_t Word(const std::string& bytes, std::size_t at) {
    std::uint32_t word;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return ntohl(word);
  }
  static void Write(int fd, const char* data, std::size_t n) {
    while (n > 0) {
      const ssize_t sent = ::send(fd, data, n, MSG_NOSIGNAL);
      if (sent <= 0) return;
      data += sent;
      n -= static_cast<std::size_t>(sent);
    }
  }

  void Serve() {
    while (!stop_) {
      std::vector<pollfd> fds{{listener_, POLLIN, 0}};
      for (const Client& client : clients_) fds.push_back({client.fd, POLLIN, 0});
      if (::poll(fds.data(), fds.size(), 20) <= 0) continue;
      for (std::size_t k = 1; k < fds.size(); ++k) {
        if (fds[k].revents != 0) Receive(&clients_[k - 1]);
      }
      clients_.erase(
          std::remove_if(clients_.begin(), clients_.end(), [](const Client& c) { return c.fd < 0; }),
          clients_.end());
      if (fds[0].revents == 0) continue;
      const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (fd < 0) continue;
      const std::uint32_t hello[] = {htonl(0x287617fa), htonl(0x0100)};
      Write(fd, reinterpret_cast<const char*>(hello), sizeof hello);
      clients_.push_back({fd, false, "", {}});
    }
  }
  void Receive(Client* client) {
    char buffer[1 << 16];
    const ssize_t n = ::recv(client->fd, buffer, sizeof buffer, 0);
    if (n <= 0) {
      ::close(client->fd);
      client->fd = -1;
      return;
    }
    client->in.append(buffer, static_cast<std::size_t>(n));
    if (!client->greeted && client->in.size() >= 8) {
      client->in.erase(0, 8);
      client->greeted = true;
    }
    while (client->greeted && TakeMessage(client)) {
    }
  }
  // False where the next message is not there as a whole.
  bool TakeMessage(Client* client) {
    const std::string& in = client->in;
    if (in.size() < 8) return false;
    const std::uint32_t type = Word(in, 0), length = Word(in, 4);
    if (in.size() < 8 + length) return false;
    const std::string channel = in.substr(8, length);
    std::size_t size = 8 + length;
    if (type == kPublish) {
      if (in.size() < size + 4) return false;
      size += 4 + Word(in, size);
      if (in.size() < size) return false;
      ++n_messages_;
      for (const Client& other : clients_) {
        const bool heard =
            std::any_of(other.channels.begin(), other.channels.end(),
                        [&](const auto& pattern) { return std::regex_match(channel, std::regex(pattern)); });
        if (heard && other.fd >= 0) Write(other.fd, in.data(), size);
      }
    } else if (type == kSubscribe) {
      client->channels.push_back(channel);
    }
    client->in.erase(0, size);
    return true;
  }

  int listener_, port_ = 0;
  std::vector<Client> clients_;
  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> n_messages_{0};
  std::thread thread_;
};

}  // namespace evit::test
