#pragma once

#include <chrono>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/map/map_index.h"
#include "common/wire/map_wire.h"
#include "tests/helpers/clouds.h"

namespace evit::test {

/// Sends queries to map_server and keeps the answers.
class Asker {
 public:
  explicit Asker(Bus* bus, const std::string& prefix = "") : bus_(bus), channels_(prefix) {
    bus_->Subscribe(channels_.map_points,
                    [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                      map_points_t m;
                      if (DecodeChecked(data, size, &m)) answers.push_back(std::move(m));
                    });
    bus_->Subscribe(channels_.status, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
      service_status_t m;
      if (!DecodeChecked(data, size, &m) || m.service != "map_server") return;
      state = m.state;
      detail = m.detail;
      for (int k = 0; k < m.n_counters; ++k) counters[m.counter_name[k]] = m.counter_value[k];
      for (int k = 0; k < m.n_timings; ++k) timings[m.timing_name[k]] = m.timing_ms[k];
    });
  }

  void SendRaw(const std::vector<std::uint8_t>& bytes) {
    bus_->Publish(channels_.map_query, bytes.data(), bytes.size());
  }
  void Send(const map_query_t& query) {
    std::vector<std::uint8_t> bytes;
    EncodeTo(query, &bytes);
    SendRaw(bytes);
  }

  std::vector<map_points_t> answers;
  std::map<std::string, std::int64_t> counters;
  std::map<std::string, double> timings;
  std::string state, detail;

 private:
  Bus* bus_;
  Channels channels_;
};

/// A query as it is asked of the library.
inline VisibilityQuery LibraryQuery() {
  VisibilityQuery q;
  q.T_map_camera = {Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized())),
                    {0.1, -0.2, 0.3}};
  q.camera = PlumbBob();
  q.margin_px = 30;
  q.min_depth = 0.2;
  q.max_depth = 8;
  q.max_points = 700;
  q.seed = 99;
  return q;
}

/// The same as a message.
inline map_query_t QueryMessage(std::int64_t seq) {
  const VisibilityQuery q = LibraryQuery();
  map_query_t m = ToMessage(q);
  m.utime = 1'000'000 + seq;
  m.seq = seq;
  m.epoch = 5;
  return m;
}

/// Queries that must not be answered, each wrong in one way.
inline std::vector<std::pair<const char*, map_query_t>> AbsurdQueries() {
  std::vector<std::pair<const char*, map_query_t>> bad;
  const auto add = [&](const char* name, const auto& change) {
    map_query_t m = QueryMessage(1);
    change(&m);
    bad.emplace_back(name, m);
  };
  add("NaN position", [](auto* m) { m->position[1] = std::nan(""); });
  add("infinite depth", [](auto* m) { m->max_depth = 1.0 / 0.0; });
  add("no unit quaternion", [](auto* m) { m->orientation[3] += 0.1; });
  add("no rotation",
      [](auto* m) { m->orientation[0] = m->orientation[1] = m->orientation[2] = m->orientation[3] = 0; });
  add("width 0", [](auto* m) { m->camera.width = 0; });
  add("huge image", [](auto* m) { m->camera.height = 2'000'000'000; });
  add("focal length 0", [](auto* m) { m->camera.fx = 0; });
  add("unknown lens", [](auto* m) { m->camera.model = "fish"; });
  add("negative margin", [](auto* m) { m->margin_px = -1; });
  add("huge margin", [](auto* m) { m->margin_px = 1e9; });
  add("no depth range", [](auto* m) { m->min_depth = m->max_depth; });
  add("negative max_points", [](auto* m) { m->max_points = -1; });
  add("no max_points", [](auto* m) { m->max_points = 0; });
  add("huge max_points", [](auto* m) { m->max_points = 1'000'000; });
  add("negative seq", [](auto* m) { m->seq = -1; });
  return bad;
}

}  // namespace evit::test
