#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/render/render_run.h"

namespace evit::commands {

void AddRenderCommand(CLI::App* app) {
  struct Options {
    render::RenderOptions render;
    std::string seconds;
  };
  auto o = std::make_shared<Options>();
  render::RenderOptions& r = o->render;
  CLI::App* command =
      app->add_subcommand("render", "Make a film of a run that was recorded (evit run --record)");
  command->add_option("log", r.log, "LCM log with KEYFRAME and WINDOW_STATE")->required();
  command->add_option("--map", r.map, "Map: PCD, PLY or text")->required();
  command->add_option("--rig", r.rig, "Calibration")->required();
  command->add_option("--out", r.out, "Film to write: .mp4 or .gif")->required();
  command->add_option("--seconds", o->seconds, "A:B in s, only this part");
  command->add_option("--fps", r.fps, "Pictures per second")
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str();
  command->add_option("--speed", r.speed, "Seconds of the recording per second")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  command->add_option("--width", r.paint.size.width, "Pixels; the height is 9/16 of it")
      ->check(CLI::Range(320, 3840))
      ->capture_default_str();
  command
      ->add_option("--turn", r.paint.turn_deg,
                   "Direction the map is looked at along, degrees from its x axis")
      ->capture_default_str();
  command
      ->add_option("--turning", r.paint.turn_deg_per_s,
                   "How fast the view turns, degrees per s of the recording")
      ->capture_default_str();
  command->add_flag("--dark", r.paint.dark, "On a dark ground");
  command->add_option("--prefix", r.prefix, "Prefix of all channels");
  command->footer("Example: evit render run.lcmlog --map desk.pcd --rig rig.textproto --out run.mp4");
  command->callback([o] {
    render::RenderOptions& options = o->render;
    RequireOutput("--out", options.out);
    RequireNotAnInput("--out", options.out, {options.log, options.map, options.rig});
    if (!o->seconds.empty()) options.seconds = ParseSeconds(o->seconds);
    options.paint.size.width &= ~1;  // films have even sides
    options.paint.size.height = options.paint.size.width * 9 / 16 & ~1;
    const int n = render::RenderRun(options);
    std::printf("%s: %d pictures, %.1f MB\n", options.out.c_str(), n,
                1e-6 * static_cast<double>(std::filesystem::file_size(options.out)));
  });
}

}  // namespace evit::commands
