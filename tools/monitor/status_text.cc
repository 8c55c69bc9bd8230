#include "tools/monitor/status_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/service/status_reporter.h"

namespace evit::monitor {
namespace {

using nlohmann::json;

// Names and details come from the bus and may hold anything: what is not UTF-8 is replaced.
std::string Dump(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json ServiceJson(const PipelineWatch::Service& service, std::int64_t now) {
  const service_status_t& s = service.status;
  json counters = json::object(), timings = json::object();
  for (std::size_t i = 0; i < s.counter_name.size(); ++i) counters[s.counter_name[i]] = s.counter_value[i];
  for (std::size_t i = 0; i < s.timing_name.size(); ++i) timings[s.timing_name[i]] = s.timing_ms[i];
  return {{"name", s.service},    {"state", s.state},
          {"detail", s.detail},   {"progress", s.progress},
          {"epoch", s.epoch},     {"age_s", 1e-6 * static_cast<double>(now - service.heard)},
          {"counters", counters}, {"timings_ms", timings}};
}

json ProcessesJson(const procman::Sheriff& sheriff) {
  json processes = json::array();
  for (const auto& [deputy, info] : sheriff.deputies()) {
    for (const auto& status : info.cmds) {
      processes.push_back({{"deputy", deputy},
                           {"name", status.cmd.command_id},
                           {"pid", status.pid},
                           {"cpu", status.cpu_usage},
                           {"memory_mb", static_cast<double>(status.mem_rss_bytes) / (1 << 20)},
                           {"restarting", sheriff.pending(status.cmd.command_id)}});
    }
  }
  return processes;
}

json ChannelsJson(const ChannelWatch& channels) {
  json result = json::array();
  for (const auto& [name, figures] : channels.channels()) {
    result.push_back({{"name", name},
                      {"rate_hz", figures.rate_hz},
                      {"received", figures.received},
                      {"lost", figures.lost},
                      {"invalid", figures.invalid},
                      {"restarts", figures.restarts}});
  }
  return result;
}

json MountJson(const CameraMount& mount) {
  if (!mount.camera()) return nullptr;
  const Camera& camera = *mount.camera();
  json result = {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
                 {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
  if (mount.T_body_camera()) {
    const SE3& T = *mount.T_body_camera();
    result["position"] = std::vector<double>(T.p.data(), T.p.data() + 3);
    result["orientation"] = std::vector<double>(T.q.coeffs().data(), T.q.coeffs().data() + 4);
  }
  return result;
}

}  // namespace

std::string StatusText(const PipelineWatch* watch, const procman::Sheriff* sheriff,
                       const MonitorFigures& figures) {
  json text = {{"type", "status"},
               {"read_only", figures.read_only},
               {"viewers", figures.viewers},
               {"waiting", figures.waiting}};
  text["services"] = json::array();
  if (watch != nullptr) {
    const std::int64_t now = HostTime();
    for (const auto& [name, service] : watch->services())
      text["services"].push_back(ServiceJson(service, now));
    text["channels"] = ChannelsJson(watch->channels());
    text["camera"] = MountJson(watch->mount());
    text["map"] = {{"known", watch->map().points().size()}, {"total", watch->map().total()}};
  }
  if (sheriff != nullptr) text["processes"] = ProcessesJson(*sheriff);
  return Dump(text);
}

std::string ModeText(const tracker_mode_t& mode) {
  static constexpr const char* kNames[] = {"bootstrapping", "tracking", "lost"};
  return Dump({{"type", "mode"}, {"mode", kNames[mode.mode]}, {"reason", mode.reason}});
}

std::string PlacesText(const places_t& places) {
  constexpr std::size_t kMost = 32;
  json list = json::array();
  for (std::size_t i = 0; i < std::min(kMost, places.position.size()); ++i) {
    list.push_back({{"position", places.position[i]},
                    {"orientation", places.orientation[i]},
                    {"significance", places.significance[i]}});
  }
  return Dump({{"type", "places"}, {"places", list}});
}

std::string DrawnText(double ms) { return Dump({{"type", "drawn"}, {"picture_ms", ms}}); }

std::string AnswerText(bool ok, const std::string& text) {
  return Dump({{"type", "answer"}, {"ok", ok}, {"text", text}});
}

}  // namespace evit::monitor
