#include "tools/paper/paper_plan.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "tools/paper/jerk.h"
#include "tools/paper/program_ids.h"
#include "tools/paper/selection.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

constexpr double kBefore = 3.0, kAfter = 0.7;  // s of the figures' run around its most jerky moment

// CPU seconds of a run per second of the sequence, roughly, over two processors.
double CostPerSecond(const paper::Method& method) {
  const double rate = method.has_fixed_rate_hz() && method.fixed_rate_hz() > 0 ? method.fixed_rate_hz() : 60;
  return 0.5 + 0.009 * rate;
}

// `seconds`: part of the log, "A:B"; made when the run begins; empty function: all of it.
PaperJob RunJobOf(const Recording& recording, const paper::Method& method, const std::string& folder,
                  const std::string& program_id, bool record, const std::function<std::string()>& seconds) {
  const std::string settings = TrackerText(method);
  const std::string& start = recording.sequence->start();
  PaperJob job;
  job.id = (record ? "figures " : "run ") + recording.name + " " + method.id();
  job.folder = folder;
  job.key = "recording " + HexText(HashOf(recording.job.key)) + "\nstart " + start +
            (record ? "\nfigures\n" : "\n") + settings + "program " + program_id + "\n";
  job.good_codes = {0, 2};  // 2: LOST, a result too
  job.prepare = [=] {
    const std::string config = folder + "/tracker.textproto";
    WriteText(config, settings);
    std::vector<std::string> words{"evit",        "run",           "--log",       recording.log, "--map",
                                   recording.map, "--rig",         recording.rig, "--config",    config,
                                   "--truth",     recording.truth, "--out",       folder};
    if (start.empty() || seconds) {
      words.insert(words.end(), {"--initial-from", recording.truth});
    } else {
      words.insert(words.end(), {"--initial-pose", start});
    }
    if (IsPhotometric(method)) words.insert(words.end(), {"--photometric-map", recording.photometric_map});
    if (seconds) words.insert(words.end(), {"--seconds", seconds()});
    if (record) words.insert(words.end(), {"--record", folder + "/" + kKeyframeLog});
    return PaperJob::Commands{words};
  };
  return job;
}

// Around the most jerky moment of the truth.
std::string JerkySeconds(const std::string& truth_file) {
  const Trajectory truth = ReadTum(truth_file);
  const double at = ToSeconds(MostJerky(truth, kBefore, kAfter) - truth.front().t);
  char text[64];
  std::snprintf(text, sizeof text, "%.3f:%.3f", std::max(0.0, at - kBefore), at + kAfter);
  return text;
}

void PlanRuns(const PaperOptions& options, const std::string& work, PaperPlan* plan) {
  const Selection selection(plan->config, options.only);
  const std::string program_id = TrackingProgramId(options.programs);
  for (std::size_t k = 0; k < plan->recordings.size(); ++k) {
    const Recording& recording = plan->recordings[k];
    for (const paper::Method& method : AllMethods(plan->config)) {
      PlannedRun run;
      run.photometric = IsPhotometric(method);
      if (run.photometric && recording.photometric_map.empty()) {
        plan->left_out.push_back(
            recording.name + " " + method.id() +
            ": there is no photometric map of it; make one with `evit map photometric` (see "
            "`photometric_map` in tools/paper/paper.proto)");
        continue;
      }
      run.recording = k;
      run.method = method;
      run.selected = selection.Wants(*recording.sequence, method);
      run.job = RunJobOf(recording, method, work + "/runs/" + recording.name + "/" + method.id(), program_id,
                         false, {});
      run.job.cost = recording.seconds * CostPerSecond(method);
      plan->runs.push_back(run);
      if (recording.sequence->name() != plan->config.figure_sequence() || recording.seed != 1 ||
          method.id() != plan->config.figure_method())
        continue;
      run.job = RunJobOf(recording, method, work + "/figures/" + recording.name, program_id, true,
                         [truth = recording.truth] { return JerkySeconds(truth); });
      run.job.cost = (kBefore + kAfter) * CostPerSecond(method);
      plan->figure_run = run;
    }
  }
}

}  // namespace

PaperPlan MakePlan(const PaperOptions& options) {
  PaperPlan plan;
  plan.config = LoadPaper(options.config);
  RecordingOptions recording;
  recording.vector = options.vector;
  recording.shared_data = options.shared_data;
  recording.work = std::filesystem::absolute(options.out).lexically_normal().string() + "/work";
  recording.seconds = options.quick ? plan.config.quick_s() : plan.config.simulated_s();
  recording.seeds = options.seeds.value_or(options.quick ? 1 : plan.config.seeds());
  bool any_recorded = false;
  for (const paper::Sequence& sequence : plan.config.sequence()) {
    for (Recording& r : RecordingsOf(plan.config, sequence, recording)) {
      any_recorded = any_recorded || r.source.rfind("recorded", 0) == 0;
      plan.recordings.push_back(std::move(r));
    }
  }
  if (!options.vector.empty() && !any_recorded) {
    throw std::runtime_error(options.vector + ": holds no sequence of the configuration, e.g. " +
                             plan.config.sequence(0).name() +
                             "1.synced.left_event.hdf5 with .imu.txt and .gt.txt");
  }
  PlanRuns(options, recording.work, &plan);
  if (JobsOf(plan).empty()) {
    throw std::runtime_error(
        "--only: no run matches all of these words (tables, sequences and methods narrow each other)");
  }
  return plan;
}

std::vector<PaperJob> JobsOf(const PaperPlan& plan) {
  std::vector<PaperJob> jobs;
  for (std::size_t k = 0; k < plan.recordings.size(); ++k) {
    std::vector<const PlannedRun*> runs;
    for (const PlannedRun& run : plan.runs) {
      if (run.recording == k && run.selected) runs.push_back(&run);
    }
    if (plan.figure_run && plan.figure_run->recording == k && plan.figure_run->selected)
      runs.push_back(&*plan.figure_run);
    if (runs.empty()) continue;
    const std::size_t recording = jobs.size();
    std::size_t map = recording;
    jobs.push_back(plan.recordings[k].job);
    const bool photometric =
        std::any_of(runs.begin(), runs.end(), [](const auto* run) { return run->photometric; });
    if (photometric && plan.recordings[k].photometric_job) {
      map = jobs.size();
      jobs.push_back(*plan.recordings[k].photometric_job);
      jobs.back().needs = {recording};
    }
    for (const PlannedRun* run : runs) {
      jobs.push_back(run->job);
      jobs.back().needs = {run->photometric ? map : recording};
    }
  }
  return jobs;
}

PaperResults CollectResults(const PaperPlan& plan) {
  PaperResults results;
  std::map<std::pair<std::string, std::string>, bool> whole;
  for (const PlannedRun& run : plan.runs) {
    const Recording& recording = plan.recordings[run.recording];
    const auto key = std::pair(recording.sequence->name(), run.method.id());
    const bool done = IsDone(run.job);
    whole.emplace(key, true).first->second &= done;
    if (!done) continue;
    results.runs[key].push_back(ScoreRun(run.job.folder, recording.truth));
    results.sources[key.first] = recording.source;
  }
  for (const auto& [key, all] : whole) {
    if (!all) results.runs.erase(key);
  }
  return results;
}

}  // namespace evit::paper
