#pragma once

#include <string>
#include <vector>

namespace evit::monitor {

/// Who may connect. A browser says on whose behalf it asks (Origin) and which name it looked up (Host): both
/// are checked, so that neither a page from elsewhere nor a name that its owner points at this host
/// (DNS rebinding) reaches the bus.
class OriginPolicy {
 public:
  /// `bind`: the address served; where it is 0.0.0.0, every address literal is a name of this host.
  /// `also`: further origins, e.g. "https://app.foxglove.dev".
  OriginPolicy(std::string bind, std::vector<std::string> also);

  /// `host`: the Host header, with or without a port.
  bool AllowsHost(const std::string& host) const;
  /// `origin`: empty where there is none, as from a program that is not a browser.
  bool Allows(const std::string& origin, const std::string& host) const;

 private:
  std::string bind_;
  std::vector<std::string> also_;
};

}  // namespace evit::monitor
