#include "tools/feed/feed_input.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace evit::feed {
namespace {

constexpr int kReceiveBuffer = 8 << 20;  // bytes asked for: 0.1 s of five million events a second

[[noreturn]] void Fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ > STDERR_FILENO) close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

bool Readable(int fd, int timeout_ms) {
  pollfd wait{fd, POLLIN, 0};
  return poll(&wait, 1, timeout_ms) > 0;
}

class DescriptorInput : public FeedInput {
 public:
  DescriptorInput(Descriptor fd, std::string name, bool datagrams)
      : fd_(std::move(fd)), name_(std::move(name)), datagrams_(datagrams) {}

  State Read(std::uint8_t* out, std::size_t capacity, int timeout_ms, std::size_t* n) override {
    *n = 0;
    if (!Readable(fd_.get(), timeout_ms)) return State::kPause;
    const ssize_t got = read(fd_.get(), out, capacity);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) return State::kPause;
    if (got < 0 && errno != ECONNRESET) Fail(name_);
    if (got <= 0) return datagrams_ ? State::kPause : State::kEnd;
    *n = static_cast<std::size_t>(got);
    return State::kData;
  }
  std::string name() const override { return name_; }

 private:
  Descriptor fd_;
  std::string name_;
  bool datagrams_;
};

Descriptor Bound(int port, int type, const std::string& name) {
  Descriptor fd(socket(AF_INET, type | SOCK_CLOEXEC, 0));
  if (fd.get() < 0) Fail(name);
  const int on = 1;
  setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  setsockopt(fd.get(), SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    Fail(name + " cannot be listened to");
  return fd;
}

// Waits for its driver within Read, so that Ctrl-C is heard.
class TcpInput : public FeedInput {
 public:
  explicit TcpInput(int port)
      : name_("tcp port " + std::to_string(port)), listener_(Bound(port, SOCK_STREAM, name_)) {
    if (listen(listener_.get(), 1) != 0) Fail(name_);
  }
  State Read(std::uint8_t* out, std::size_t capacity, int timeout_ms, std::size_t* n) override {
    *n = 0;
    if (!connection_) {
      if (!Readable(listener_.get(), timeout_ms)) return State::kPause;
      Descriptor accepted(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (accepted.get() < 0) return State::kPause;
      connection_ = std::make_unique<DescriptorInput>(std::move(accepted), name_, false);
    }
    return connection_->Read(out, capacity, timeout_ms, n);
  }
  std::string name() const override { return name_; }

 private:
  std::string name_;
  Descriptor listener_;
  std::unique_ptr<DescriptorInput> connection_;
};

}  // namespace

std::unique_ptr<FeedInput> OpenStandardInput() {
  return std::make_unique<DescriptorInput>(Descriptor(STDIN_FILENO), "standard input", false);
}

std::unique_ptr<FeedInput> ListenTcp(int port) { return std::make_unique<TcpInput>(port); }

std::unique_ptr<FeedInput> ListenUdp(int port) {
  const std::string name = "udp port " + std::to_string(port);
  return std::make_unique<DescriptorInput>(Bound(port, SOCK_DGRAM, name), name, true);
}

}  // namespace evit::feed
