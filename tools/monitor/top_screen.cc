#include "tools/monitor/top_screen.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "common/geometry/degrees.h"
#include "common/service/status_reporter.h"
#include "common/text/format_text.h"

namespace evit::monitor {
namespace {

constexpr char kPlain[] = "\x1b[0m", kDim[] = "\x1b[2m", kGood[] = "\x1b[1;34m", kWait[] = "\x1b[1;33m",
               kBad[] = "\x1b[1;31m";
constexpr double kSilentS = 3;  // services send STATUS once a second

// Text from the bus must not steer the terminal.
std::string Printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  }
  return text;
}

struct Line {
  const char* color;
  std::string text;
};

double SecondsSince(std::int64_t heard) { return 1e-6 * static_cast<double>(HostTime() - heard); }

// Why nothing more is to come; empty while something may.
std::string Ended(const PipelineWatch& watch) {
  const auto& services = watch.services();
  if (services.empty()) return "";
  bool finished = true, silent = true;
  double age = 1e9;
  for (const auto& [name, service] : services) {
    // log_replay is done before the others: what it sent is still being worked on.
    if (name != "log_replay" || services.size() == 1)
      finished = finished && service.status.state == "finished";
    silent = silent && SecondsSince(service.heard) > kSilentS;
    age = std::min(age, SecondsSince(service.heard));
  }
  if (finished) return "its services have finished";
  return silent ? FormatText("no service has been heard for %.0f s", age) : "";
}

Line ModeLine(const PipelineWatch& watch) {
  static constexpr const char* kNames[] = {"BOOTSTRAPPING", "TRACKING", "LOST"};
  static constexpr const char* kColors[] = {kWait, kGood, kBad};
  const std::string ended = Ended(watch);
  if (!watch.has_mode()) {
    if (ended.empty()) return {kWait, "no word of the tracker yet"};
    return {kBad, "ENDED  " + ended + "; the tracker said nothing"};
  }
  const tracker_mode_t& mode = watch.mode();
  const std::string text = std::string(kNames[mode.mode]) + "  " + Printable(mode.reason);
  if (!ended.empty()) return {kDim, "ENDED  " + ended + "; the last was: " + text};
  return {kColors[mode.mode], text};
}

// Its state where one deputy has such a command: its own, or the only one.
const procman_lcm::cmd_status_t* ProcessOf(const procman::Sheriff& sheriff, const std::string& own,
                                           const std::string& name) {
  const procman_lcm::cmd_status_t* found = nullptr;
  int n = 0;
  for (const auto& [deputy, info] : sheriff.deputies()) {
    for (const auto& status : info.cmds) {
      if (status.cmd.command_id != name) continue;
      if (deputy == own) return &status;
      found = &status;
      ++n;
    }
  }
  return n == 1 ? found : nullptr;
}

std::int64_t SumOfCounters(const service_status_t& status, const std::string& end) {
  std::int64_t sum = -1;  // none
  for (std::size_t i = 0; i < status.counter_name.size(); ++i) {
    const std::string& name = status.counter_name[i];
    if (name.size() < end.size() || name.compare(name.size() - end.size(), end.size(), end) != 0) continue;
    sum = std::max<std::int64_t>(sum, 0) + status.counter_value[i];
  }
  return sum;
}

// Messages that wait in a service now.
std::string QueueText(const service_status_t& status) {
  const std::int64_t waiting = SumOfCounters(status, ".queued");
  return waiting < 0 ? "" : std::to_string(waiting);
}

std::string OverloadText(const PipelineWatch& watch) {
  const auto optimizer = watch.services().find("window_optimizer");
  if (optimizer == watch.services().end()) return "not known";
  const std::int64_t level = SumOfCounters(optimizer->second.status, "overload.level");
  return level <= 0 ? "none" : "level " + std::to_string(level) + " of 4";
}

Line ServiceLine(const PipelineWatch::Service& service, const procman_lcm::cmd_status_t* process) {
  const service_status_t& s = service.status;
  const double age_s = SecondsSince(service.heard);
  const bool silent = age_s > kSilentS && s.state != "finished";
  const bool bad = silent || s.state == "failed" || s.state == "degraded";
  std::string load = "                        ";
  if (process != nullptr && process->pid != 0) {
    load = FormatText("%5.0f %% %6.0f MB %6s", 100.0 * static_cast<double>(process->cpu_usage),
                      static_cast<double>(process->mem_rss_bytes) / (1 << 20), QueueText(s).c_str());
  }
  const std::string state = silent ? FormatText("silent %.0f s", age_s) : Printable(s.state);
  return {bad ? kBad : kPlain, FormatText("%-18s %-12s %s  ", Printable(s.service).substr(0, 40).c_str(),
                                          state.substr(0, 40).c_str(), load.c_str()) +
                                   Printable(s.detail)};
}

}  // namespace

TopScreen::TopScreen(PipelineWatch* watch, const procman::Sheriff* sheriff, std::string prefix)
    : watch_(watch), sheriff_(sheriff), deputy_("evit" + std::move(prefix)) {
  watch->AddListener(this);
}

// Deputies of other pipelines; empty where there are none.
std::string TopScreen::OthersOnBus() const {
  std::string others;
  int n = 0;
  for (const auto& [deputy, info] : sheriff_->deputies()) {
    const bool tracks = std::any_of(info.cmds.begin(), info.cmds.end(), [](const auto& status) {
      return status.pid != 0 && status.cmd.command_id == "window_optimizer";
    });
    n += tracks ? 1 : 0;
    if (tracks && deputy != deputy_) others += (others.empty() ? "" : ", ") + Printable(deputy);
  }
  return n > 1 ? others : "";
}

void TopScreen::OnWindow(const window_state_t& window, double latency_ms) {
  window_ = window;
  latency_ms_ = latency_ms;
}

std::string TopScreen::Draw(int columns, int rows, bool color) const {
  std::vector<Line> lines = {ModeLine(*watch_)};
  const std::string others = OthersOnBus();
  if (!others.empty())
    lines.push_back({kWait, "more pipelines on this bus (" + others +
                                "): this shows channels with the prefix given; others: --prefix"});
  const double* p = pose_.position;
  const double* v = pose_.velocity;
  lines.push_back({kPlain, has_pose_
                               ? FormatText("position %7.2f %7.2f %7.2f m   speed %5.2f m/s", p[0], p[1],
                                            p[2], std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]))
                               : "position -   speed -"});
  const auto& c = window_.covariance;
  const std::string latency = latency_ms_ < 0 ? "not in real time" : FormatText("%.0f ms", latency_ms_);
  // While it looks for its pose, and while events do not count, there is nothing to say of them.
  const bool tracks = watch_->has_mode() && watch_->mode().mode == tracker_mode_t::TRACKING;
  const std::string sigma =
      tracks ? FormatText("sigma %5.1f mm, %.2f deg",
                          1e3 * std::sqrt(std::max(0.0, c[0][0] + c[1][1] + c[2][2])),
                          kDegreesPerRadian * std::sqrt(std::max(0.0, c[3][3] + c[4][4] + c[5][5])))
             : "sigma -";
  const std::string points =
      tracks && window_.n_points > 0
          ? FormatText("points %d, %.0f %% on edges", window_.n_points, 100 * window_.inlier_share)
          : "points -";
  lines.push_back({kPlain, sigma + "   " + points});
  lines.push_back({kPlain, FormatText("solve %5.1f ms   latency %s   overload %s", window_.solve_ms,
                                      latency.c_str(), OverloadText(*watch_).c_str())});
  lines.push_back({kPlain, ""});
  lines.push_back({kDim, "SERVICE            STATE            CPU    MEMORY  QUEUE"});
  for (const auto& [name, service] : watch_->services()) {
    lines.push_back(ServiceLine(service, ProcessOf(*sheriff_, deputy_, name)));
  }
  lines.push_back({kPlain, ""});
  lines.push_back({kDim, "CHANNEL                PER S   RECEIVED     LOST  INVALID"});
  for (const auto& [name, f] : watch_->channels().channels()) {
    lines.push_back({f.lost + f.invalid > 0 ? kWait : kPlain,
                     FormatText("%-20s %7.0f %10lld %8lld %8lld", name.substr(0, 40).c_str(), f.rate_hz,
                                static_cast<long long>(f.received), static_cast<long long>(f.lost),
                                static_cast<long long>(f.invalid))});
  }
  std::string screen;
  for (std::size_t i = 0; i < std::min(lines.size(), static_cast<std::size_t>(std::max(rows, 1))); ++i) {
    const std::string text = lines[i].text.substr(0, static_cast<std::size_t>(std::max(columns, 1)));
    screen += color ? std::string(lines[i].color) + text + kPlain + "\x1b[K\n" : text + "\n";
  }
  return screen;
}

}  // namespace evit::monitor
