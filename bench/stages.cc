#include "bench/stages.h"

#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "tools/pictures/chart.h"

namespace evit::bench {
namespace {

struct Stage {
  std::string name;
  double ms;  // for each keyframe
  cv::Scalar color;
};

// How often a stage is gone through: once, but the map is asked only where the view has moved.
double TimesPerKeyframe(const nlohmann::json& service, const std::string& timing, double keyframes) {
  return timing == "query" ? service["counters"].value("MAP_QUERY.received", keyframes) / keyframes : 1;
}

std::vector<Stage> Stages(const nlohmann::json& report) {
  const double keyframes = report["keyframes"].get<double>();
  if (!(keyframes > 0)) throw std::runtime_error("the report holds no keyframe");
  std::vector<Stage> stages;
  // Each service: the stages it times itself, then the rest of its CPU time: messages, decoding, the kernel.
  const struct {
    const char *service, *rest;
    std::vector<std::pair<const char*, const char*>> timed;
    cv::Scalar color;
  } kParts[] = {{"log_replay", "log_replay: read the log, send", {}, {170, 170, 170}},
                {"frame_builder",
                 "frame_builder: receive, decode, merge, send",
                 {
                     {"update", "frame_builder: surface of active events"},
                     {"render", "frame_builder: time surface"},
                 },
                 {200, 140, 40}},
                {"map_server",
                 "map_server: load, receive, send",
                 {{"query", "map_server: visible points"}},
                 {60, 150, 60}},
                {"window_optimizer",
                 "window_optimizer: receive, send",
                 {{"solve", "window_optimizer: sample, solve, quality"}},
                 {50, 80, 220}}};
  for (const auto& part : kParts) {
    for (const auto& service : report["services"]) {
      if (service["name"] != part.service) continue;
      double rest = 1e3 * service["cpu_s"].get<double>() / keyframes;
      for (const auto& [timing, name] : part.timed) {
        const double ms =
            service["mean_ms"].value(timing, 0.0) * TimesPerKeyframe(service, timing, keyframes);
        stages.push_back({name, ms, part.color});
        rest -= ms;
      }
      stages.push_back({part.rest, std::max(rest, 0.0), part.color * 0.6 + cv::Scalar::all(100)});
    }
  }
  return stages;
}

}  // namespace

void DrawStages(const nlohmann::json& report, const std::string& png) {
  const std::vector<Stage> stages = Stages(report);
  double longest = 0, total = 0;
  for (const Stage& stage : stages) longest = std::max(longest, stage.ms), total += stage.ms;
  constexpr int kRow = 34, kLeft = 400, kWidth = 1000, kTop = 60;
  cv::Mat image(kTop + kRow * static_cast<int>(stages.size()) + 20, kWidth, CV_8UC3, cv::Scalar::all(255));
  char text[120];
  std::snprintf(text, sizeof text,
                "CPU time of one keyframe, all processes: %.1f ms (%.2f million events/s, %.0f keyframes/s)",
                total, 1e-6 * report["event_rate_per_s"].get<double>(),
                report["keyframe_rate_hz"].get<double>());
  pictures::DrawText(&image, text, {kWidth / 2, 32}, 0.6, pictures::Anchor::kCenter);
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const int y = kTop + kRow * static_cast<int>(k);
    const int length = static_cast<int>(stages[k].ms / longest * (kWidth - kLeft - 90));
    cv::rectangle(image, cv::Rect(kLeft, y + 5, std::max(length, 1), kRow - 10), stages[k].color, cv::FILLED);
    pictures::DrawText(&image, stages[k].name, {kLeft - 10, y + kRow / 2 + 5}, 0.5, pictures::Anchor::kRight);
    std::snprintf(text, sizeof text, "%.2f ms", stages[k].ms);
    pictures::DrawText(&image, text, {kLeft + length + 8, y + kRow / 2 + 5}, 0.5, pictures::Anchor::kLeft);
  }
  if (!cv::imwrite(png, image)) throw std::runtime_error(png + ": cannot be written");
}

}  // namespace evit::bench
