#include "common/bus/channel_filter.h"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace evit {
namespace {

// Bytes into the datagram, whose UDP header a socket's filter sees. LCM's headers: magic, number of the
// message; of a fragment also the message's size, the fragment's place in it, its number and how many there
// are.
constexpr std::uint32_t kMagic = 8, kShortName = 16, kFragmentNumber = 24, kFragmentName = 28;
constexpr std::uint32_t kShort = 0x4c433032, kFragment = 0x4c433033;  // LC02, LC03
constexpr std::uint32_t kPass = 0xffffffff, kDrop = 0;

sock_filter Statement(std::uint16_t code, std::uint32_t k) { return BPF_STMT(code, k); }
// Skips so many instructions where the accumulator is k, or is not.
sock_filter IfEqual(std::uint32_t k, std::size_t yes, std::size_t no) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, k, static_cast<std::uint8_t>(yes),
                  static_cast<std::uint8_t>(no));
}

// Passes the datagram where `name` and its closing zero begin at the index register. Compared from the front,
// so that nothing is read beyond the end of a shorter name.
void AppendName(const std::string& name, std::vector<sock_filter>* program) {
  std::string bytes = name;
  bytes.push_back('\0');
  struct Part {
    std::uint32_t at, value;
    std::uint16_t size;
  };
  std::vector<Part> parts;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t left = bytes.size() - at, size = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < size; ++k) value = value << 8 | static_cast<std::uint8_t>(bytes[at + k]);
    parts.push_back({static_cast<std::uint32_t>(at), value,
                     static_cast<std::uint16_t>(size == 4   ? BPF_W
                                                : size == 2 ? BPF_H
                                                            : BPF_B)});
    at += size;
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    program->push_back(Statement(static_cast<std::uint16_t>(BPF_LD | BPF_IND | parts[k].size), parts[k].at));
    program->push_back(IfEqual(parts[k].value, 0, 2 * (parts.size() - k - 1) + 1));
  }
  program->push_back(Statement(BPF_RET | BPF_K, kPass));
}

std::vector<sock_filter> Program(const std::vector<std::string>& channels) {
  std::vector<sock_filter> program{
      Statement(BPF_LD | BPF_W | BPF_ABS, kMagic),
      IfEqual(kShort, 0, 2),
      Statement(BPF_LDX | BPF_W | BPF_IMM, kShortName),
      Statement(BPF_JMP | BPF_JA, 5),
      IfEqual(kFragment, 0, 2),
      Statement(BPF_LD | BPF_H | BPF_ABS, kFragmentNumber),
      IfEqual(0, 1, 0),
      Statement(BPF_RET | BPF_K, kPass),
      Statement(BPF_LDX | BPF_W | BPF_IMM, kFragmentName),
  };
  for (const std::string& name : channels) AppendName(name, &program);
  program.push_back(Statement(BPF_RET | BPF_K, kDrop));
  return program;
}

}  // namespace

std::vector<int> SocketsOnPort(int port) {
  std::vector<int> sockets;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const int fd = std::atoi(entry.path().filename().c_str());
    sockaddr_in address{};
    socklen_t size = sizeof address;
    int type = 0;
    socklen_t type_size = sizeof type;
    if (::getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM) continue;
    if (::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        address.sin_family != AF_INET || address.sin_port != htons(static_cast<std::uint16_t>(port)))
      continue;
    sockets.push_back(fd);
  }
  return sockets;
}

bool HearOnlyChannels(int socket, const std::vector<std::string>& channels) {
  std::vector<sock_filter> program = Program(channels);
  sock_fprog description{};
  description.len = static_cast<unsigned short>(program.size());  // NOLINT(google-runtime-int): the kernel's
  description.filter = program.data();
  if (program.size() <= BPF_MAXINSNS &&
      ::setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &description, sizeof description) == 0)
    return true;
  const int none = 0;  // the channels before must not stay: messages of the new ones would be dropped
  (void)::setsockopt(socket, SOL_SOCKET, SO_DETACH_FILTER, &none, sizeof none);
  return false;
}

}  // namespace evit
