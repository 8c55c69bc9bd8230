#include "common/bus/lcm_connection.h"

#include <csignal>
#include <stdexcept>

#include "common/bus/limits.h"

namespace evit {

LcmConnection::LcmConnection(const std::string& url) {
  RequireSharedBus(url);
  url_ = ParseLcmUrl(url);
  std::string granted_url = url;
  if (url_.server) {
    RequireServer(url_);
    std::signal(SIGPIPE,
                SIG_IGN);  // a server that goes away is an error of sending, not the end of the process
    if (url.find(':', std::string("tcpq://").size()) == std::string::npos)
      granted_url = "tcpq://" + url_.host + ":" + std::to_string(url_.port);
  }
  if (url_.multicast) {
    RequireMulticastRoute(url_);
    granted_ = ProbeReceiveBuffer(url_.receive_buffer > 0 ? url_.receive_buffer : kDefaultReceiveBuffer);
    // Asking LCM for no more than will be granted keeps its warning off stderr; STATUS says what was
    // granted.
    granted_url = WithReceiveBuffer(url, granted_);
  }
  lcm_.reset(lcm_create(granted_url.c_str()));
  if (lcm_ == nullptr) {
    throw std::runtime_error(
        "cannot open the LCM bus \"" + url +
        "\": check the URL (udpm://239.255.76.67:7667?ttl=0) and that multicast is routed");
  }
}

void LcmConnection::Publish(const std::string& channel, const void* data, std::size_t size) {
  if (size > kMaxMessageBytes || channel.size() > LCM_MAX_CHANNEL_NAME_LENGTH || !Connected() ||
      lcm_publish(lcm_.get(), channel.c_str(), data, static_cast<unsigned>(size)) != 0) {
    ++send_errors_;
  }
}

void LcmConnection::RequireConnection() const {
  if (Connected()) return;
  throw std::runtime_error("tcpq: the server at " + url_.host + ":" + std::to_string(url_.port) +
                           " is gone; start it, then this program, again");
}

}  // namespace evit
