#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/monitor/frame.h"
#include "tools/monitor/origin.h"
#include "tools/monitor/web_file.h"

namespace evit::monitor {

using ClientId = std::int64_t;

/// What a WebServer tells of its WebSocket clients, and asks for. Called from WebServer::Service().
class WebClients {
 public:
  virtual ~WebClients() = default;
  virtual void Connected(ClientId client, const std::string& protocol) = 0;
  virtual void Closed(ClientId client) = 0;
  /// A whole message, at most 64 kB: a client that sends more is cut off.
  virtual void Received(ClientId client, std::string_view message) = 0;
  /// The client can take another frame: the next one, null for none. More come after WebServer::Wake().
  virtual FramePtr Next(ClientId client) = 0;
};

/// HTTP for a fixed list of files, and WebSockets, on one port and in the caller's thread: Service() never
/// waits, neither for the network nor for a client. Host and Origin are checked (origin.h).
class WebServer {
 public:
  struct Options {
    std::string bind = "127.0.0.1";
    int port = 8080;  // 0: any that is free
    std::vector<std::string> protocols;
    std::vector<std::string> origins;  // allowed beside the server's own
    int max_clients = 32;              // WebSockets at a time
  };

  /// Listens. `clients` must outlive this. The file "" is the page. Throws std::runtime_error with the remedy
  /// where it cannot listen.
  WebServer(const Options& options, std::vector<WebFile> files, WebClients* clients);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// Does what there is to do, and returns.
  void Service();
  /// There were still frames to send when Service() returned.
  bool busy() const;
  /// There are frames for this client.
  void Wake(ClientId client);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace evit::monitor
