#include <string>

#include "procman/deployment.h"

namespace evit::procman {
namespace {

std::string Quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return quoted + '"';
}

std::vector<std::string> Parts(const std::string& group) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < group.size();) {
    const std::size_t end = std::min(group.find('/', begin), group.size());
    parts.push_back(group.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

void WriteCommand(const ProcmanCommand& c, const std::string& indent, const char* host, std::string* out) {
  const ProcmanCommand defaults;
  const auto line = [&](const std::string& text) { *out += indent + "    " + text + ";\n"; };
  *out += indent + "cmd " + Quote(c.id) + " {\n";
  line("exec = " + Quote(c.exec));
  line(std::string(host) + " = " + Quote(c.deputy));
  if (c.auto_respawn) line("auto_respawn = \"true\"");
  if (c.stop_signal != defaults.stop_signal) line("stop_signal = " + std::to_string(c.stop_signal));
  if (c.stop_time_allowed != defaults.stop_time_allowed) {
    line("stop_time_allowed = " + std::to_string(static_cast<int>(c.stop_time_allowed)));
  }
  *out += indent + "}\n";
}

std::string StepText(const ScriptStep& step) {
  const std::string target = (step.whole_group ? "group " : "cmd ") + Quote(step.target);
  const std::string wait = step.wait.empty() ? "" : " wait " + Quote(step.wait);
  switch (step.kind) {
    case ScriptStep::Kind::kStart:
      return "start " + target + wait;
    case ScriptStep::Kind::kStop:
      return "stop " + target + wait;
    case ScriptStep::Kind::kRestart:
      return "restart " + target + wait;
    case ScriptStep::Kind::kWaitMs:
      return "wait ms " + std::to_string(step.wait_ms);
    case ScriptStep::Kind::kWaitStatus:
      return "wait " + target + " status " + Quote(step.wait);
    case ScriptStep::Kind::kRunScript:
      return "run_script " + Quote(step.target);
  }
  return "";
}

}  // namespace

std::string WriteDeployment(const Deployment& deployment, ProcmanDialect dialect) {
  const char* host = dialect == ProcmanDialect::kProcman ? "deputy" : "host";
  std::string out;
  std::vector<std::string> open;  // groups
  const auto indent = [&] { return std::string(4 * open.size(), ' '); };
  const auto go_to = [&](const std::vector<std::string>& wanted) {
    std::size_t common = 0;
    while (common < open.size() && common < wanted.size() && open[common] == wanted[common]) ++common;
    while (open.size() > common) {
      open.pop_back();
      out += indent() + "}\n";
    }
    for (; common < wanted.size(); ++common) {
      out += indent() + "group " + Quote(wanted[common]) + " {\n";
      open.push_back(wanted[common]);
    }
  };
  for (const ProcmanCommand& command : deployment.commands) {
    go_to(Parts(command.group));
    WriteCommand(command, indent(), host, &out);
  }
  go_to({});
  for (const ProcmanScript& script : deployment.scripts) {
    out += "\nscript " + Quote(script.name) + " {\n";
    for (const ScriptStep& step : script.steps) out += "    " + StepText(step) + ";\n";
    out += "}\n";
  }
  return out;
}

}  // namespace evit::procman
