#include "tools/paper/figures.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "common/config/rig_file.h"
#include "common/map/map_file.h"
#include "tools/paper/motion_model_figure.h"
#include "tools/paper/text_files.h"
#include "tools/paper/trajectory_figure.h"
#include "tools/paper/window_figure.h"

namespace evit::paper {
namespace {

// The figures' recording; throws where there is none.
const Recording& FigureRecording(const PaperPlan& plan) {
  if (!plan.figure_run) throw std::runtime_error("no recording of " + plan.config.figure_sequence());
  return plan.recordings[plan.figure_run->recording];
}

void Trajectories(const std::string& path, const PaperPlan& plan) {
  const Recording& recording = FigureRecording(plan);
  std::vector<MethodTrajectory> methods;
  Utime first = 0, last = 0;
  for (const PlannedRun& run : plan.runs) {
    const bool in_table = std::any_of(plan.config.method().begin(), plan.config.method().end(),
                                      [&](const paper::Method& m) { return m.id() == run.method.id(); });
    if (run.recording != plan.figure_run->recording || !in_table || !IsDone(run.job)) continue;
    methods.push_back({run.method.name() + " " + run.method.frequency(), TrackedPart(run.job.folder)});
    const Trajectory& poses = methods.back().poses;
    if (poses.empty()) continue;
    first = first == 0 ? poses.front().t : std::min(first, poses.front().t);
    last = std::max(last, poses.back().t);
  }
  if (last == 0) throw std::runtime_error("no method has tracked " + recording.name);
  DrawTrajectories(path, recording.sequence->name() + " (" + recording.source + ")", ReadTum(recording.truth),
                   methods);
}

// Draws a figure of the keyframes that the figures' run recorded.
void OfKeyframes(const std::string& path, const PaperPlan& plan,
                 void (*draw)(const std::string& path, const std::string& title, const KeyframeLog&,
                              const Rig&, const MapIndex&)) {
  const Recording& recording = FigureRecording(plan);
  if (!IsDone(plan.figure_run->job))
    throw std::runtime_error("the figures' run of " + recording.name + " is missing");
  const KeyframeLog log(plan.figure_run->job.folder + "/" + kKeyframeLog);
  draw(path, recording.sequence->name() + ", " + plan.figure_run->method.name(), log, LoadRig(recording.rig),
       MapIndex(LoadMap(recording.map).map));
}

}  // namespace

std::vector<Figure> DrawFigures(const std::string& folder, const PaperPlan& plan) {
  MakeFolder(folder);
  std::vector<Figure> figures;
  const auto draw = [&](const std::string& file, const std::string& caption, const auto& how) {
    const std::string path = folder + "/" + file;
    std::filesystem::remove(path);
    try {
      how(path);
      figures.push_back({file, caption});
    } catch (const std::runtime_error& error) {
      figures.push_back({"", caption + ": not drawn, " + error.what()});
    }
  };
  draw("trajectories.png",
       "As the paper's Fig. 4: position and rotation of every method against truth over time; a curve ends, "
       "with a dot, where its "
       "method was lost",
       [&](const std::string& path) { Trajectories(path, plan); });
  draw("motion_models.png",
       "As the paper's Fig. 5: initial projection of the map on the time surface from where each motion "
       "model expects the camera, "
       "at an instant of jerky motion, and where the window then found it",
       [&](const std::string& path) { OfKeyframes(path, plan, DrawMotionModels); });
  draw("window.png",
       "As the paper's Fig. 1: a window of keyframes: fields of view on the map from above, the cameras at a "
       "larger scale with the "
       "IMU between them, and each time surface with the map on it",
       [&](const std::string& path) { OfKeyframes(path, plan, DrawWindow); });
  return figures;
}

}  // namespace evit::paper
