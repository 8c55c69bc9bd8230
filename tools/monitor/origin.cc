#include "tools/monitor/origin.h"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace evit::monitor {
namespace {

std::string WithoutPort(const std::string& host) {
  if (!host.empty() && host.front() == '[') return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.rfind(':'));
}

bool IsAddress(const std::string& name) {
  in_addr address{};
  return inet_pton(AF_INET, name.c_str(), &address) == 1;
}

std::string HostName() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

}  // namespace

OriginPolicy::OriginPolicy(std::string bind, std::vector<std::string> also)
    : bind_(std::move(bind)), also_(std::move(also)) {}

bool OriginPolicy::AllowsHost(const std::string& host) const {
  const std::string name = WithoutPort(host);
  if (name == "localhost" || name == "127.0.0.1" || name == bind_) return true;
  return bind_ == "0.0.0.0" && (IsAddress(name) || (!name.empty() && name == HostName()));
}

bool OriginPolicy::Allows(const std::string& origin, const std::string& host) const {
  if (!AllowsHost(host)) return false;
  if (origin.empty() || origin == "http://" + host) return true;
  return std::find(also_.begin(), also_.end(), origin) != also_.end();
}

}  // namespace evit::monitor
