#pragma once

#include <lcm/lcm.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "common/bus/lcm_url.h"

namespace evit {

/// liblcm at a URL: opened with the checks and the receive buffer that OpenLcmBus() promises, and sending.
class LcmConnection {
 public:
  /// Throws std::runtime_error with the remedy where the URL cannot be opened.
  explicit LcmConnection(const std::string& url);

  void Publish(const std::string& channel, const void* data, std::size_t size);

  lcm_t* lcm() const { return lcm_.get(); }
  const LcmUrl& url() const { return url_; }
  int granted_receive_buffer() const { return granted_; }  // bytes; 0: not UDP
  std::int64_t send_errors() const { return send_errors_; }

  /// LCM closes its socket where a tcpq server is gone, and then waits on none: the process would be aborted.
  bool Connected() const { return !url_.server || lcm_get_fileno(lcm_.get()) >= 0; }
  /// Throws std::runtime_error with the remedy.
  void RequireConnection() const;

 private:
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  LcmUrl url_;
  int granted_ = 0;
  std::unique_ptr<lcm_t, Destroy> lcm_;
  std::int64_t send_errors_ = 0;
};

}  // namespace evit
