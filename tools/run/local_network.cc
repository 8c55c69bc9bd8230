#include "tools/run/local_network.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "common/bus/lcm_url.h"

namespace evit::run {
namespace {

[[noreturn]] void Fail(const std::string& what) {
  throw std::runtime_error(
      "cannot make a network namespace (" + what + ": " + std::strerror(errno) +
      "); give the host's lo a multicast route instead: sudo ip link set lo multicast on && sudo "
      "ip route add 224.0.0.0/4 dev lo");
}

void WriteFile(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) Fail(path);
}

// lo up, and 224.0.0.0/4 through it: what `ip link set lo up; ip route add 224.0.0.0/4 dev lo` does.
void ConfigureLoopback() {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  if (fd < 0) Fail("socket");
  ifreq request{};
  std::strncpy(request.ifr_name, "lo", IFNAMSIZ - 1);
  request.ifr_flags = IFF_UP | IFF_RUNNING | IFF_LOOPBACK | IFF_MULTICAST;
  if (ioctl(fd, SIOCSIFFLAGS, &request) != 0) Fail("lo up");
  rtentry route{};
  const auto set = [](sockaddr* address, const char* text) {
    auto* in = reinterpret_cast<sockaddr_in*>(address);
    in->sin_family = AF_INET;
    inet_pton(AF_INET, text, &in->sin_addr);
  };
  set(&route.rt_dst, "224.0.0.0");
  set(&route.rt_genmask, "240.0.0.0");
  set(&route.rt_gateway, "0.0.0.0");
  route.rt_flags = RTF_UP;
  char device[] = "lo";
  route.rt_dev = device;
  if (ioctl(fd, SIOCADDRT, &route) != 0) Fail("route to 224.0.0.0/4");
  close(fd);
}

// Whether the route to the group leads through lo: a group that is reached through a network card would send
// out. Asks the kernel (RTM_GETROUTE); the address a connected socket gets does not tell.
bool StaysOnHost(const LcmUrl& url) {
  struct {
    nlmsghdr header;
    rtmsg route;
    rtattr destination;
    in_addr group;
  } request = {};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETROUTE;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.route.rtm_family = AF_INET;
  request.route.rtm_dst_len = 32;
  request.destination.rta_type = RTA_DST;
  request.destination.rta_len = RTA_LENGTH(sizeof request.group);
  if (inet_pton(AF_INET, url.group.c_str(), &request.group) != 1) return false;
  alignas(nlmsghdr) char answer[4096];
  const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (fd < 0) return false;
  ssize_t n = -1;
  if (send(fd, &request, sizeof request, 0) == static_cast<ssize_t>(sizeof request)) {
    n = recv(fd, answer, sizeof answer, 0);
  }
  close(fd);
  auto* header = reinterpret_cast<nlmsghdr*>(answer);
  if (n < 0 || !NLMSG_OK(header, static_cast<std::size_t>(n)) || header->nlmsg_type != RTM_NEWROUTE) {
    return false;  // no route at all
  }
  auto* route = static_cast<rtmsg*>(NLMSG_DATA(header));
  int left = static_cast<int>(RTM_PAYLOAD(header));
  for (rtattr* part = RTM_RTA(route); RTA_OK(part, left); part = RTA_NEXT(part, left)) {
    int device = 0;
    if (part->rta_type != RTA_OIF || RTA_PAYLOAD(part) != sizeof device) continue;
    std::memcpy(&device, RTA_DATA(part), sizeof device);
    return device == static_cast<int>(if_nametoindex("lo"));
  }
  return false;
}

}  // namespace

bool EnsureLocalMulticast(const std::string& url) {
  const LcmUrl parsed = ParseLcmUrl(url);
  if (!parsed.multicast || StaysOnHost(parsed)) return false;
  const std::string uid = std::to_string(getuid()), gid = std::to_string(getgid());
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) Fail("unshare");
  WriteFile("/proc/self/setgroups", "deny");
  WriteFile("/proc/self/uid_map", uid + " " + uid + " 1");
  WriteFile("/proc/self/gid_map", gid + " " + gid + " 1");
  ConfigureLoopback();
  return true;
}

bool IsLocalBus(const std::string& lcm_url) {
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  return lcm_url.empty() && (environment == nullptr || *environment == '\0');
}

void JoinNetworkOf(const RunningPipeline& pipeline) {
  const std::string folder = "/proc/" + std::to_string(pipeline.pid) + "/ns/";
  const auto same = [&](const char* name) {
    std::error_code error;
    return std::filesystem::read_symlink(folder + name, error) ==
           std::filesystem::read_symlink(std::string("/proc/self/ns/") + name, error);
  };
  for (const char* name : {"user", "net"}) {  // in this order: the first gives the right to do the second
    if (same(name)) continue;
    const int fd = open((folder + name).c_str(), O_RDONLY | O_CLOEXEC);
    const int result = fd < 0 ? -1 : setns(fd, 0);
    const std::string why = std::strerror(errno);
    if (fd >= 0) close(fd);
    if (result != 0) {
      throw std::runtime_error("cannot join the network of process " + std::to_string(pipeline.pid) + " (" +
                               why + "): it belongs to somebody else, or runs in a container");
    }
  }
}

bool CanJoinNetworkOf(const RunningPipeline& pipeline) {
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    try {
      JoinNetworkOf(pipeline);
      _exit(0);
    } catch (const std::exception&) {
      _exit(1);
    }
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace evit::run
