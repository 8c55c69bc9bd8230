#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/evaluation/trajectory.h"
#include "common/localization/place_index_file.h"
#include "common/localization/prior_text.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/evit/place_options.h"
#include "tools/locate/candidates_picture.h"
#include "tools/locate/locator_run.h"
#include "tools/locate/search_trace.h"
#include "tools/locate/start_tally.h"

namespace evit::commands {
namespace {

constexpr double kMoment = 0.1;  // s of the accelerometer that tell the vertical, where nothing else shall
constexpr double kDegree = 3.14159265358979 / 180;

struct LocateOptions {
  std::string log, map, rig, config, truth, picture;
  run::PlaceTexts place;
  double at = 0, seconds = 5, hold = 0;
  int starts = 0;
  bool trace = false;
  std::vector<std::string> without;
};

double YawDegrees(const SE3& pose) {
  const Eigen::Vector3d x = pose.q * Eigen::Vector3d::UnitX();
  return std::atan2(x.y(), x.x()) / kDegree;
}

void PrintCandidates(const std::vector<PlaceCandidate>& candidates) {
  std::printf("%10s %8s %8s %8s %13s %9s\n", "x m", "y m", "z m", "yaw deg", "significance", "likeness");
  for (const PlaceCandidate& c : candidates) {
    const Eigen::Vector3d& p = c.T_map_body.p;
    std::printf("%10.2f %8.2f %8.2f %8.0f %13.1f %9.1f\n", p.x(), p.y(), p.z(), YawDegrees(c.T_map_body),
                c.significance, c.likeness);
  }
}

// How far off a result is, for a person; `right`: whether it counts as such.
std::string Compared(const locate::LocatorResult& result, const Trajectory& truth, bool* right) {
  SE3 pose;
  if (!PoseAt(truth, result.t, &pose)) return "no truth then";
  const double m = (result.T_map_body.p - pose.p).norm();
  const double degrees = AngularDistance(result.T_map_body.q, pose.q) / kDegree;
  *right = locate::IsRight(result.T_map_body, pose);
  char text[80];
  std::snprintf(text, sizeof text, "%.1f cm, %.2f deg off: %s", 100 * m, degrees, *right ? "right" : "WRONG");
  return text;
}

// What became of it afterwards, for a person.
std::string Held(const locate::LocatorResult& result) {
  if (result.withdrawn.empty()) return "";
  char seconds[40];
  std::snprintf(seconds, sizeof seconds, "; withdrawn after %.2f s: ", result.held_s);
  return seconds + result.withdrawn;
}

// One start after the other, evenly over the recording. False: one was wrong.
bool LocateOften(const LocateOptions& o, const locate::RecordedStreams& streams,
                 const std::function<locate::LocatorResult(Utime)>& run) {
  const Trajectory truth = ReadTrajectory(o.truth);
  locate::StartTally tally;
  const double span = ToSeconds(streams.end() - streams.begin()) - 1.5;  // less is too short to be sure
  if (span <= 0) throw std::runtime_error(o.log + ": is shorter than 1.5 s: leave --starts out");
  for (int k = 0; k < o.starts; ++k) {
    const double at = span * (k + 0.5) / o.starts;
    const locate::LocatorResult result = run(streams.begin() + static_cast<Utime>(at * 1e6));
    bool right = false;
    const std::string text = result.found ? Compared(result, truth, &right) : result.progress;
    tally.Add(result, right, locate::AtOnce(result, truth));
    std::printf("start at %6.2f s: %s after %.2f s; %s%s\n", at, result.found ? "found" : "not found",
                result.after_s, text.c_str(), Held(result).c_str());
    if (o.trace) std::fputs(locate::TraceText(result, truth).c_str(), stdout);
    std::fflush(stdout);
  }
  std::printf("%s\n", tally.Line().c_str());
  return tally.wrong() == 0;
}

// What --without names.
PlaceFinderOptions LeaveOut(const std::vector<std::string>& parts, int threads, SelfLocatorOptions* search) {
  const auto out = [&parts](const char* part) {
    return std::find(parts.begin(), parts.end(), part) != parts.end();
  };
  PlaceFinderOptions finder;
  finder.threads = threads;
  finder.panoramas = !out("panoramas");
  finder.directions = !out("directions");
  search->other_verticals = !out("verticals");
  if (out("gravity")) search->up_s = kMoment;
  return finder;
}

int Locate(const LocateOptions& o) {
  RequireOutput("--picture", o.picture);
  RequireNotAnInput("--picture", o.picture, {o.log, o.map, o.rig, o.config});
  const Rig rig = LoadRig(o.rig);
  const PipelineOptions options = LoadOptionsFor(rig.camera, o.config);
  if (options.method != PipelineOptions::Method::kEvit)
    throw std::runtime_error(o.config +
                             ": EVT and EVPT need a start pose, only EVIT finds its place; use the "
                             "settings of EVIT, as config/tracker.textproto");
  LocatingTracker::Options locating;
  locating.search.prior = ParsePlacePrior(o.place.near, o.place.height, o.place.yaw);
  const int threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 4);
  const locate::RecordedStreams streams(o.log);
  const locate::PreparedMap map = locate::PrepareMap(o.map, threads);
  const std::string kept = KeptPlaceIndexText(o.map);
  std::printf("%zu places, %.1f MB%s\n", map.places->places().size(),
              1e-6 * static_cast<double>(map.places->MemoryBytes()),
              kept.empty() ? "" : (", kept for the next time in " + kept).c_str());
  std::fflush(stdout);
  const PlaceFinderOptions finder = LeaveOut(o.without, threads, &locating.search);
  const auto run = [&](Utime begin) {
    return locate::RunLocator(streams, map, rig, options, locating, finder, begin, o.seconds, o.hold);
  };
  if (o.starts > 0) return LocateOften(o, streams, run) ? 0 : 2;
  const Utime begin = streams.begin() + static_cast<Utime>(o.at * 1e6);
  if (begin >= streams.end()) throw std::runtime_error("--at: the log ends before that");
  const locate::LocatorResult result = run(begin);
  PrintCandidates(result.candidates);
  if (!o.picture.empty() && !result.candidates.empty()) {
    locate::WriteCandidates(o.picture, result.surface, *map.map, rig, result.candidates);
    std::printf("picture: %s\n", o.picture.c_str());
  }
  if (!result.found) {
    std::printf("not found within %.2f s: %s\n", result.after_s, result.progress.c_str());
    return 2;
  }
  const std::string line = TumLine({0, result.T_map_body});
  std::printf("found after %.2f s: --initial-pose \"%s\"\n", result.after_s,
              line.substr(line.find(' ') + 1).c_str());
  bool right = true;
  if (!o.truth.empty()) std::printf("%s\n", Compared(result, ReadTrajectory(o.truth), &right).c_str());
  return right ? 0 : 2;
}

}  // namespace

void AddLocateCommand(CLI::App* app) {
  auto o = std::make_shared<LocateOptions>();
  CLI::App* locate =
      app->add_subcommand("locate", "Where in the map does a recording begin, or was at a time?");
  locate->add_option("--log", o->log, "LCM log with EVENTS and IMU (evit import)")->required();
  locate->add_option("--map", o->map, "Semi-dense map: PCD, PLY or text, metres, z up")->required();
  locate->add_option("--rig", o->rig, "Calibration, e.g. config/vector/rig.textproto")->required();
  locate->add_option("--config", o->config, "Tracker settings (default: EVIT's, see evit config show)");
  AddPlaceOptions(locate, &o->place);
  auto* at = locate->add_option("--at", o->at, "s from the start of the log, where to begin")
                 ->check(CLI::NonNegativeNumber);
  locate->add_option("--for", o->seconds, "s of the log to decide in")->check(CLI::PositiveNumber);
  locate->add_option("--hold", o->hold, "s to track beyond that, to see whether it stays there")
      ->check(CLI::NonNegativeNumber);
  auto* picture =
      locate->add_option("--picture", o->picture, "PNG to write: events and map, of the best candidates");
  auto* truth = locate->add_option("--truth", o->truth, "Truth (TUM) to compare with");
  auto* starts = locate
                     ->add_option("--starts", o->starts,
                                  "Begin so many times, evenly over the log, and count what is right")
                     ->check(CLI::Range(1, 100'000))
                     ->needs(truth)
                     ->excludes(at)
                     ->excludes(picture);
  locate->add_flag("--trace", o->trace, "With --starts: how each went, search by search")->needs(starts);
  locate
      ->add_option(
          "--without", o->without,
          "Parts to leave out, to see what they are worth: panoramas, directions (of edges), gravity (but "
          "that of the last 0.1 s), verticals (other than the likeliest)")
      ->delimiter(',')
      ->check(CLI::IsMember({"panoramas", "directions", "gravity", "verticals"}));
  locate->footer(
      "Example: evit locate --log desk.lcmlog --map desk/map.pcd --rig desk/rig.textproto --at 2 --picture "
      "at2.png\n"
      "Exit code: 0 found (with truth: and right), 1 could not run, 2 not found, ambiguous, or wrong.");
  locate->callback([o] {
    const int code = Locate(*o);
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace evit::commands
