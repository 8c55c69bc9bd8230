#include "tools/paper/recording.h"

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "tools/paper/program_ids.h"
#include "tools/paper/recorded_files.h"
#include "tools/paper/text_files.h"

namespace evit::paper {
namespace {

namespace fs = std::filesystem;

std::string Text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// Calibration of the regular camera that maps are made with.
std::string LeftCamera(const paper::Paper& config) {
  return (fs::path(config.rig()).parent_path() / "left_camera.textproto").string();
}

// A large file as it is now: hashing it would take long.
std::string Identity(const std::string& path) {
  const auto time = fs::last_write_time(path).time_since_epoch().count();
  return path + " " + std::to_string(fs::file_size(path)) + " bytes, written " + std::to_string(time) + "\n";
}

// The photometric map from the posed images that a simulation leaves.
PaperJob PhotometricJob(const Recording& recording, const std::string& images) {
  PaperJob job;
  job.id = "map " + recording.name;
  job.folder = fs::path(recording.photometric_map).parent_path().string();
  job.key = "recording " + HexText(HashOf(recording.job.key)) + "\nprogram " + PhotometricProgramId() + "\n";
  job.cost = 10;
  const std::vector<std::string> words{"evit", "map",   "photometric",
                                       images, "--out", recording.photometric_map};
  job.prepare = [words] { return PaperJob::Commands{words}; };
  return job;
}

Recording SimulatedRecording(const paper::Paper& config, const paper::Sequence& sequence,
                             const RecordingOptions& options, int seed) {
  Recording r;
  r.sequence = &sequence;
  r.seed = seed;
  r.name = sequence.name() + "." + Text(options.seconds) + "s." + std::to_string(seed);
  r.seconds = options.seconds;
  const std::string folder = options.work + "/recordings/" + r.name, made = folder + "/simulation";
  r.log = folder + "/sequence.lcmlog";
  r.map = made + "/map.pcd";
  r.truth = made + "/truth.tum";
  r.rig = made + "/rig.textproto";

  const paper::Simulated& motion = sequence.simulated();
  std::vector<std::string> words{"evit", "simulate", "--name", sequence.name(), "--scene",
                                 std::to_string(seed), "--seed", std::to_string(seed), "--rig", config.rig(),
                                 "--rgbd",
                                 // A third less to render than by default, and the same errors.
                                 "--max-step-px", "1", "--profile", config.profile()};
  std::string inputs = "rig " + HexText(HashOfFile(config.rig())) + "\n";
  const std::string recorded = motion.has_recorded() && !options.shared_data.empty()
                                   ? options.shared_data + "/" + motion.recorded()
                                   : "";
  if (!recorded.empty() && fs::exists(recorded)) {
    const double begin = motion.recorded_begin_s();
    words.insert(words.end(),
                 {"--trajectory", recorded, "--seconds", Text(begin) + ":" + Text(begin + options.seconds)});
    inputs += "motion " + HexText(HashOfFile(recorded)) + "\n";
    r.source = "simulated from VECtor's recorded motion " + fs::path(recorded).stem().string();
  } else {
    words.insert(words.end(), {"--trajectory", motion.builtin(), "--duration", Text(options.seconds),
                               "--motion-seed", std::to_string(seed)});
    r.source = "simulated, " + motion.builtin();
  }
  r.source += ", " + Text(options.seconds) + " s, " + std::to_string(options.seeds) +
              (options.seeds == 1 ? " room" : " rooms") + ", profile " + config.profile();
  r.job.id = "simulate " + r.name;
  r.job.folder = folder;
  r.job.key = Joined(words) + "\n" + inputs + "program " + RecordingProgramId() + "\n";
  r.job.cost = 11 * options.seconds;
  const std::vector<std::string> import{"evit",          "import", "vector", made,    "--sequence",
                                        sequence.name(), "--rig",  r.rig,    "--out", r.log};
  words.insert(words.end(), {"--threads", std::to_string(options.threads), "--out", made});
  r.job.prepare = [words, import] { return PaperJob::Commands{words, import}; };
  r.photometric_map = options.work + "/photometric/" + r.name + "/map.ply";
  r.photometric_job = PhotometricJob(r, made + "/rgbd");
  r.job.finish = [made] {  // the log holds the events now
    for (const auto& entry : fs::directory_iterator(made)) {
      if (entry.path().extension() == ".hdf5") fs::remove(entry.path());
    }
  };
  return r;
}

Recording Recorded(const paper::Paper& config, const paper::Sequence& sequence,
                   const RecordingOptions& options, const RecordedFiles& files) {
  Recording r;
  r.sequence = &sequence;
  r.name = sequence.name() + ".recorded";
  r.source = "recorded";
  const std::string folder = options.work + "/recordings/" + r.name;
  r.log = folder + "/sequence.lcmlog";
  r.map = files.map.empty() ? folder + "/map.pcd" : files.map;
  r.photometric_map = files.photometric_map;
  r.truth = r.log + ".truth.tum";
  r.rig = config.rig();

  std::vector<std::string> words{"evit", "import"};
  std::string inputs = "rig " + HexText(HashOfFile(config.rig())) + "\n";
  if (files.bags.empty()) {
    words.insert(words.end(), {"vector", files.folder, "--sequence", sequence.name()});
    for (const char* end : {"left_event.hdf5", "imu.txt", "gt.txt"})
      inputs += Identity(files.folder + "/" + sequence.name() + "1.synced." + end);
  } else {
    words.emplace_back("bag");
    words.insert(words.end(), files.bags.begin(), files.bags.end());
    for (const std::string& bag : files.bags) inputs += Identity(bag);
  }
  words.insert(words.end(), {"--rig", config.rig()});
  if (sequence.has_begin_s()) {
    r.seconds = sequence.end_s() - sequence.begin_s();
    words.insert(words.end(), {"--seconds", Text(sequence.begin_s()) + ":" + Text(sequence.end_s())});
    r.source += ", " + Text(sequence.begin_s()) + " to " + Text(sequence.end_s()) + " s";
  }
  if (sequence.t_map_world_size() == 16) {
    std::string matrix;
    for (const double v : sequence.t_map_world()) matrix += (matrix.empty() ? "" : " ") + Text(v);
    words.insert(words.end(), {"--T-map-world", matrix});
  }
  // The import leaves poses of the body in the map's frame.
  const std::vector<std::string> build{
      "evit",       "map",  "build",    "--images",         files.pictures, "--poses", r.truth,
      "--poses-of", "body", "--camera", LeftCamera(config), "--out",        r.map};
  r.job.id = "import " + r.name;
  r.job.folder = folder;
  if (files.map.empty()) {
    inputs += "pictures " + files.pictures + "\ncamera " + HexText(HashOfFile(LeftCamera(config))) +
              "\nmap " + Joined(build) + "\n";
    r.source += ", map made of its pictures";
  } else {
    inputs += "map " + Identity(files.map);
  }
  if (!files.photometric_map.empty()) inputs += "photometric map " + Identity(files.photometric_map);
  r.job.key = Joined(words) + "\n" + inputs + "program " + RecordingProgramId() + "\n";
  r.job.cost = 1.5 * r.seconds;
  words.insert(words.end(), {"--out", r.log});
  const bool has_map = !files.map.empty();
  r.job.prepare = [words, build, has_map] {
    return has_map ? PaperJob::Commands{words} : PaperJob::Commands{words, build};
  };
  return r;
}

}  // namespace

std::vector<Recording> RecordingsOf(const paper::Paper& config, const paper::Sequence& sequence,
                                    const RecordingOptions& options) {
  if (!options.vector.empty()) {
    if (const auto files = FindRecorded(options.vector, sequence))
      return {Recorded(config, sequence, options, *files)};
  }
  std::vector<Recording> all;
  for (int seed = 1; seed <= options.seeds; ++seed)
    all.push_back(SimulatedRecording(config, sequence, options, seed));
  return all;
}

}  // namespace evit::paper
