#include "tools/evit/deployment_files.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "procman/command_line.h"

namespace evit::commands {
namespace {

void RequireFile(const std::string& name, const std::string& value) {
  if (value.empty()) throw std::runtime_error(name + " is empty; it names a file");
  const std::string given = name + "=" + value;
  std::error_code error;
  if (std::filesystem::is_directory(value, error))
    throw std::runtime_error(given + ": is a folder, not a file");
  if (std::filesystem::exists(value, error)) return;
  throw std::runtime_error(given + ": there is no such file in " + std::filesystem::current_path().string());
}

std::optional<std::string> FileVariable(const std::string& name) {
  const char* const value = std::getenv(name.c_str());
  if (value == nullptr) return std::nullopt;
  for (const char* file : {"EVIT_MAP", "EVIT_RIG", "EVIT_CONFIG", "EVIT_LOG"}) {
    if (name == file) RequireFile(name, value);
  }
  return value;
}

}  // namespace

void RequireFiles(const procman::Deployment& deployment, const std::string& script,
                  const std::string& deputy) {
  const procman::ProcmanScript* const found = deployment.FindScript(script);
  if (found == nullptr) return;  // the runner says so, and which there are
  for (const procman::ScriptStep& step : found->steps) {
    using Kind = procman::ScriptStep::Kind;
    if (step.kind == Kind::kRunScript) RequireFiles(deployment, step.target, deputy);  // none runs itself
    if (step.kind != Kind::kStart && step.kind != Kind::kRestart) continue;
    for (const std::string& id : deployment.Targets(step)) {
      const procman::ProcmanCommand* const command = deployment.Find(id);
      if (command != nullptr && command->deputy == deputy)
        procman::SplitCommandLine(command->exec, FileVariable);
    }
  }
}

}  // namespace evit::commands
