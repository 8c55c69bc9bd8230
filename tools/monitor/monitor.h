#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/geometry/se3.h"
#include "tools/monitor/foxglove_audience.h"
#include "tools/monitor/order_desk.h"
#include "tools/monitor/page_audience.h"
#include "tools/monitor/pipeline_watch.h"
#include "tools/monitor/web_server.h"

namespace evit::monitor {

struct MonitorOptions {
  WebServer::Options web;
  bool read_only = false;  // no order of a viewer reaches the bus
  std::string prefix;      // of all channels
  std::string map, rig;  // files; empty: the pipeline's, where it runs on this host, else learnt from the bus
  pid_t pipeline = 0;    // of all that run on this host show this one only; 0: the newest
};

/// Shows a pipeline to viewers. One thread; nothing waits for a viewer.
class Monitor : private WebClients {
 public:
  /// Listens for viewers at once, before there is a bus. Throws std::runtime_error where the port or a file
  /// cannot be used.
  explicit Monitor(const MonitorOptions& options);
  ~Monitor() override;

  int port() const { return server_.port(); }
  /// From now on it shows what comes over this bus, which must outlive it.
  void Watch(Bus* bus);
  /// The map and the rig to show, files; an empty name: as it was. Throws std::runtime_error where one is no
  /// good.
  void ShowFiles(const std::string& map, const std::string& rig);
  /// Where the tracked body is at the begin of its recording. Only where it watches a bus.
  void SetStart(const SE3& T_map_body) { desk_->SetStart(T_map_body); }
  /// What it waits for while there is no bus, for people.
  void SetWaiting(const std::string& why);
  /// Call often; at once where busy().
  void Tick();
  bool busy() const { return server_.busy(); }

 private:
  void Connected(ClientId client, const std::string& protocol) override;
  void Closed(ClientId client) override;
  void Received(ClientId client, std::string_view message) override;
  FramePtr Next(ClientId client) override;
  std::string Give(const PageOrder& order);

  MonitorOptions options_;
  PageAudience page_;
  FoxgloveAudience foxglove_;
  std::map<ClientId, WebClients*> clients_;  // who looks after whom
  WebServer server_;
  std::unique_ptr<PipelineWatch> watch_;
  std::unique_ptr<procman::Sheriff> sheriff_;
  std::unique_ptr<OrderDesk> desk_;
  std::string waiting_;
  std::int64_t reported_ = 0, rates_updated_ = 0;  // us, host clock
};

}  // namespace evit::monitor
