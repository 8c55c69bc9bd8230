#include "tools/mapping/map_check.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/evit/commands.h"
#include "tools/evit/output_names.h"
#include "tools/mapping/check_findings.h"
#include "tools/mapping/check_pictures.h"
#include "tools/terminal/progress_bar.h"

namespace evit::commands {
namespace {

nlohmann::json CheckJson(const mapping::MapCheck& check) {
  const MapEventOverlap& o = check.overlap;
  nlohmann::json fits = nlohmann::json::object();
  static constexpr const char* kNames[] = {"time_s", "rotation_rad", "shift_m",
                                           "scale",  "focal",        "centre_px"};
  for (const Misplacement& fit : check.fits) {
    nlohmann::json value = fit.value.x();
    if (fit.kind == Misplacement::Kind::kRotation || fit.kind == Misplacement::Kind::kShift)
      value = {fit.value.x(), fit.value.y(), fit.value.z()};
    if (fit.kind == Misplacement::Kind::kCentre) value = {fit.value.x(), fit.value.y()};
    fits[kNames[static_cast<int>(fit.kind)]] = {{"value", value}, {"points_on_events", fit.point_share}};
  }
  nlohmann::json views = nlohmann::json::array();
  for (std::size_t k = 0; k < check.views.size(); ++k) {
    views.push_back({{"utime", check.views[k].utime},
                     {"points_on_events", check.moments[k].point_share()},
                     {"events_on_map", check.moments[k].event_share()}});
  }
  nlohmann::json findings = nlohmann::json::array();
  for (const mapping::CheckFinding& f : check.findings)
    findings.push_back({{"severity", f.is_error ? "error" : "warning"}, {"what", f.text}});
  nlohmann::json json = {{"points_on_events", o.point_share()},
                         {"points_on_events_by_chance", o.point_share_by_chance()},
                         {"events_on_map", o.event_share()},
                         {"events_on_map_by_chance", o.event_share_by_chance()},
                         {"mean_offset_px", {o.mean_offset().x(), o.mean_offset().y()}},
                         {"cells", check.cells},
                         {"cells_seen", check.cells_seen},
                         {"cells_silent", check.cells_silent},
                         {"points_on_events_of_fits_sample", check.point_share},
                         {"fits", fits},
                         {"views", views},
                         {"moments_planned", check.moments_planned},
                         {"findings", findings}};
  if (check.has_imu) json["tilt_deg"] = check.tilt_deg;
  return json;
}

}  // namespace

void AddMapCheck(CLI::App* map) {
  struct Options {
    mapping::MapCheckInputs inputs;
    std::string out;
    bool json = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = map->add_subcommand(
      "check",
      "How a map lies on the events of a recording with known poses, and what is wrong if it does not");
  command->add_option("--log", o->inputs.log, "LCM log with EVENTS, and IMU for gravity (evit import)")
      ->required();
  command->add_option("--map", o->inputs.map, "Semi-dense map: PCD, PLY or text, metres")->required();
  command->add_option("--rig", o->inputs.rig, "Rig file")->required();
  command->add_option("--truth", o->inputs.truth, "TUM file: body in the map frame (LOG.truth.tum)")
      ->required();
  command->add_flag("--json", o->json, "Machine-readable output");
  command->add_option("--out", o->out, "Folder for pictures of the best, a middling and the worst view");
  command->footer(
      "Example: evit map check --log desk.lcmlog --map desk.pcd --rig rig.textproto --truth "
      "desk.lcmlog.truth.tum --out check\n"
      "Exit code: 0 nothing looks wrong, 2 an error, 3 warnings only.\n"
      "In the pictures pixels that fired are grey, points of the map on them blue, others orange.");
  command->callback([o] {
    RequireOutputFolder("--out", o->out);
    mapping::MapCheck check;
    {
      terminal::ProgressBar bar("checking");
      bar.Show(0);
      check = mapping::CheckMap(o->inputs, [&](double share) { bar.Show(share); });
    }
    if (!o->out.empty()) mapping::WriteCheckPictures(o->out, o->inputs.rig, check);
    std::printf("%s", o->json ? (CheckJson(check).dump(2) + "\n").c_str()
                              : mapping::CheckText(o->inputs, check).c_str());
    if (!check.findings.empty()) throw CLI::RuntimeError(check.findings.front().is_error ? 2 : 3);
  });
}

}  // namespace evit::commands
