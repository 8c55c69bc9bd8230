#include "tools/monitor/monitor.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "common/config/rig_file.h"
#include "common/map/map_file.h"
#include "common/service/status_reporter.h"
#include "tools/monitor/page_files.h"
#include "tools/monitor/status_text.h"

namespace evit::monitor {
namespace {

constexpr std::int64_t kReportPeriodUs = 400'000;
constexpr std::int64_t kRatePeriodUs = 1'000'000;
constexpr auto kDeputySilence = std::chrono::seconds(4);  // they send once a second

WebServer::Options WithProtocols(WebServer::Options options) {
  options.protocols = {PageAudience::kProtocol, FoxgloveAudience::kProtocol};
  return options;
}

}  // namespace

Monitor::Monitor(const MonitorOptions& options)
    : options_(options),
      page_([this](ClientId client) { server_.Wake(client); },
            [this](const PageOrder& order) { return Give(order); }),
      foxglove_([this](ClientId client) { server_.Wake(client); }),
      server_(WithProtocols(options.web), LoadPage(PageFolder()), this) {}

Monitor::~Monitor() = default;

void Monitor::Watch(Bus* bus) {
  const Channels channels(options_.prefix);
  watch_ = std::make_unique<PipelineWatch>(bus, channels);
  sheriff_ = std::make_unique<procman::Sheriff>(bus);
  desk_ = std::make_unique<OrderDesk>(bus, channels, watch_.get(), sheriff_.get());
  ShowFiles(options_.map, options_.rig);
  watch_->AddListener(&page_);
  watch_->AddListener(&foxglove_);
  page_.SetPipeline(watch_->map(), &watch_->latency());
  foxglove_.SetMap(watch_->map());
  sheriff_->Discover();
  waiting_.clear();
  reported_ = 0;
}

void Monitor::ShowFiles(const std::string& map, const std::string& rig) {
  if (!map.empty()) watch_->map()->Set(LoadMap(map).map.points);
  if (rig.empty()) return;
  const Rig loaded = LoadRig(rig);
  watch_->mount()->Set(loaded.camera, loaded.T_body_camera);
}

void Monitor::SetWaiting(const std::string& why) {
  waiting_ = why;
  reported_ = 0;
}

void Monitor::Tick() {
  const std::int64_t now = HostTime();
  if (sheriff_) sheriff_->Tick();
  if (watch_ && now - rates_updated_ >= kRatePeriodUs) {
    rates_updated_ = now;
    watch_->UpdateRates();
    sheriff_->Forget(kDeputySilence);
  }
  if (now - reported_ >= kReportPeriodUs) {
    reported_ = now;
    page_.Publish("status", StatusText(watch_.get(), sheriff_.get(),
                                       {options_.read_only, static_cast<int>(clients_.size()), waiting_}));
  }
  foxglove_.Tick();
  server_.Service();
}

std::string Monitor::Give(const PageOrder& order) {
  if (options_.read_only) throw std::runtime_error("this monitor is read-only");
  if (!desk_) throw std::runtime_error("no pipeline is running");
  return desk_->Give(order);
}

void Monitor::Connected(ClientId client, const std::string& protocol) {
  WebClients* audience = &page_;
  if (protocol == FoxgloveAudience::kProtocol) audience = &foxglove_;
  clients_[client] = audience;
  audience->Connected(client, protocol);
}

void Monitor::Closed(ClientId client) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  found->second->Closed(client);
  clients_.erase(found);
}

void Monitor::Received(ClientId client, std::string_view message) {
  clients_.at(client)->Received(client, message);
}

FramePtr Monitor::Next(ClientId client) { return clients_.at(client)->Next(client); }

}  // namespace evit::monitor
