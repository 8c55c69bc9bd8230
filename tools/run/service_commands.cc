#include "tools/run/service_commands.h"

#include <filesystem>
#include <utility>

#include "common/evaluation/trajectory.h"
#include "procman/command_line.h"

namespace evit::run {

namespace {

constexpr char kCheckpoint[] = "checkpoint", kPosition[] = "position";  // files for restarts within a run

std::string RestartFile(const RunJob& job, const char* name) { return job.out + "/" + name; }

std::string PoseText(const SE3& pose) {
  const std::string line = TumLine({0, pose});
  return line.substr(line.find(' ') + 1);
}

}  // namespace

void RemoveRestartFiles(const RunJob& job) {
  for (const char* name : {kCheckpoint, kPosition}) std::filesystem::remove(RestartFile(job, name));
}

std::vector<procman::ProcmanCommand> ServiceCommands(const RunJob& job, const std::string& url,
                                                     const RunInputs& inputs) {
  RemoveRestartFiles(job);  // of an earlier run
  std::vector<std::string> map_server{"map_server"};
  if (!job.map.empty()) map_server.insert(map_server.end(), {"--map", job.map});
  if (!job.photometric_map.empty())
    map_server.insert(map_server.end(), {"--photometric-map", job.photometric_map});
  std::vector<std::string> optimizer{"window_optimizer", "--rig", job.rig};
  if (inputs.start) {
    optimizer.insert(optimizer.end(), {"--initial-pose", PoseText(*inputs.start)});
  } else {
    map_server.emplace_back("--places");
  }
  const std::pair<const char*, const std::string&> known[] = {
      {"--near", job.place.near}, {"--height", job.place.height}, {"--yaw", job.place.yaw}};
  for (const auto& [option, text] : known)
    if (!text.empty()) optimizer.insert(optimizer.end(), {option, text});
  std::vector<std::string> builder{"frame_builder", "--rig", job.rig, "--imu", inputs.has_imu ? "yes" : "no"};
  if (!job.config.empty()) {
    for (auto* words : {&optimizer, &builder}) words->insert(words->end(), {"--config", job.config});
  }
  std::vector<std::string> replay{"log_replay", "--log", job.log};
  if (!inputs.log_prefix.empty()) replay.insert(replay.end(), {"--log-prefix", inputs.log_prefix});
  if (job.tolerate.truncated) replay.emplace_back("--allow-truncated");
  if (job.play.seconds) {
    const auto [begin, end] = *job.play.seconds;
    replay.insert(replay.end(), {"--seconds", std::to_string(begin) + ":" + std::to_string(end)});
  }
  if (!job.play.lossless) {
    optimizer.insert(optimizer.end(), {"--checkpoint", RestartFile(job, kCheckpoint)});
    // In real time nobody waits: playing begins when all the others are there.
    replay.insert(replay.end(), {"--speed", std::to_string(job.play.speed), "--start-paused", "--position",
                                 RestartFile(job, kPosition)});
  }
  std::vector<procman::ProcmanCommand> commands;
  for (std::vector<std::string>* words : {&map_server, &optimizer, &builder, &replay}) {
    words->insert(words->end(), {"--lcm-url", url});
    if (!job.prefix.empty()) words->insert(words->end(), {"--prefix", job.prefix});
    if (job.play.lossless && words != &map_server) words->emplace_back("--lossless");
    procman::ProcmanCommand command;
    command.id = words->front();
    command.exec = procman::JoinCommandLine(*words);
    command.group = "evit";
    // Lossless replay counts every message, so a service that restarts in the middle cannot catch up; only
    // map_server keeps no count.
    command.auto_respawn = !job.play.lossless || words == &map_server;
    command.stop_time_allowed = 2;
    commands.push_back(std::move(command));
  }
  return commands;
}

}  // namespace evit::run
