#include "tools/monitor/page_order.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace evit::monitor {
namespace {

using nlohmann::json;

constexpr std::size_t kLongest = 4096;  // bytes
constexpr double kFarthest = 1e5;       // m
constexpr double kFastest = 100;        // times real time
constexpr double kLatestUs = 9e15;      // exact as a double

[[noreturn]] void Refuse(const std::string& why) { throw std::runtime_error("order refused: " + why); }

double Number(const json& value, const char* name, double min, double max) {
  if (!value.is_number()) Refuse(std::string(name) + " is not a number");
  const double number = value.get<double>();
  if (!(number >= min && number <= max)) Refuse(std::string(name) + " is out of range");
  return number;
}

const json& Field(const json& order, const char* name) {
  const auto found = order.find(name);
  if (found == order.end()) Refuse(std::string(name) + " is missing");
  return *found;
}

void ReadNumbers(const json& order, const char* name, double limit, double* to, std::size_t n) {
  const json& values = Field(order, name);
  if (!values.is_array() || values.size() != n) Refuse(std::string(name) + " has a wrong length");
  for (std::size_t i = 0; i < n; ++i) to[i] = Number(values[i], name, -limit, limit);
}

SE3 ReadPose(const json& order) {
  Eigen::Vector3d p;
  Eigen::Quaterniond q;
  ReadNumbers(order, "position", kFarthest, p.data(), 3);
  ReadNumbers(order, "orientation", 1.01, q.coeffs().data(), 4);
  if (std::abs(q.norm() - 1) > 1e-2) Refuse("orientation is not a unit quaternion");
  return {q.normalized(), p};
}

std::string ReadCommand(const json& order) {
  const json& command = Field(order, "command");
  if (!command.is_string() || command.get_ref<const std::string&>().empty()) Refuse("command is not a name");
  return command.get<std::string>();
}

}  // namespace

PageOrder ParsePageOrder(std::string_view text) {
  if (text.size() > kLongest) Refuse("longer than 4 kB");
  const json order = json::parse(text.begin(), text.end(), nullptr, false);
  if (!order.is_object()) Refuse("no JSON object");
  const json& name = Field(order, "order");
  PageOrder result;
  if (name == "drawn") {
    result.kind = PageOrder::Kind::kAcknowledge;
    if (order.contains("utime")) {
      result.drawn_utime = Number(order["utime"], "utime", -kLatestUs, kLatestUs);
    }
  } else if (name == "restart") {
    result.kind = PageOrder::Kind::kRestart;
    result.command = ReadCommand(order);
  } else if (name == "pause") {
    result.kind = PageOrder::Kind::kPause;
  } else if (name == "resume") {
    result.kind = PageOrder::Kind::kResume;
  } else if (name == "seek") {
    result.kind = PageOrder::Kind::kSeek;
    result.seek_share = Number(Field(order, "share"), "share", 0, 1);
  } else if (name == "speed") {
    result.kind = PageOrder::Kind::kSpeed;
    result.speed = Number(Field(order, "speed"), "speed", 0.01, kFastest);
  } else if (name == "hint") {
    result.kind = PageOrder::Kind::kHint;
    result.T_map_body = ReadPose(order);
  } else {
    Refuse("unknown");
  }
  return result;
}

}  // namespace evit::monitor
