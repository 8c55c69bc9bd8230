// The grammar: cmd "id" { exec = "..."; deputy = "..."; ... }, group "g" { ... } and
// script "s" { start|stop|restart cmd|group "id" [wait "status"]; wait ms N; wait cmd|group "id" status "s";
// run_script "s"; }
#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "procman/deployment.h"
#include "procman/token.h"

namespace evit::procman {
namespace {

constexpr int kDeepest = 16;  // groups in groups

class Parser {
 public:
  Parser(const std::string& text, const std::string& file) : file_(file), tokens_(Tokenize(text, file)) {}

  Deployment Run() {
    while (Peek().kind != Token::Kind::kEnd) Element("", 0);
    return std::move(deployment_);
  }

 private:
  void Element(const std::string& group, int depth) {
    const Token word = Take(Token::Kind::kWord, "cmd, group or script");
    if (word.text == "cmd") {
      Command(group);
    } else if (word.text == "group") {
      Group(group, depth);
    } else if (word.text == "script" && depth == 0) {
      Script();
    } else {
      Fail(word,
           "cmd, group" + std::string(depth == 0 ? " or script" : "") + " is expected, not " + word.text);
    }
  }

  void Group(const std::string& outer, int depth) {
    const Token name = Take(Token::Kind::kText, "the group's name in quotes");
    if (name.text.empty() || name.text.find('/') != std::string::npos)
      Fail(name, "a group's name is not empty and has no /");
    if (depth >= kDeepest) Fail(name, "groups are nested too deep");
    const std::string path = outer.empty() ? name.text : outer + "/" + name.text;
    Sign("{");
    while (!TakeSign("}")) Element(path, depth + 1);
  }

  void Command(const std::string& group) {
    ProcmanCommand command;
    const Token id = Take(Token::Kind::kText, "the command's id in quotes");
    if (id.text.empty()) Fail(id, "a command's id is empty");
    if (deployment_.Find(id.text) != nullptr) Fail(id, "there is a command \"" + id.text + "\" already");
    command.id = id.text;
    command.group = group;
    Sign("{");
    while (!TakeSign("}")) Attribute(&command);
    if (command.exec.empty()) Fail(id, "command \"" + id.text + "\" has no exec = \"...\";");
    if (command.deputy.empty()) {
      Fail(id, "command \"" + id.text + "\" has no deputy = \"...\"; (bot-procman: host)");
    }
    deployment_.commands.push_back(std::move(command));
  }

  void Attribute(ProcmanCommand* command) {
    const Token name = Take(Token::Kind::kWord, "an attribute");
    Sign("=");
    const Token value = tokens_[at_];
    if (name.text == "exec") {
      command->exec = Take(Token::Kind::kText, "a command line in quotes").text;
    } else if (name.text == "deputy" || name.text == "host") {
      command->deputy = Take(Token::Kind::kText, "a name in quotes").text;
    } else if (name.text == "auto_respawn") {
      ++at_;
      if (value.text != "true" && value.text != "false") Fail(value, "auto_respawn is \"true\" or \"false\"");
      command->auto_respawn = value.text == "true";
    } else if (name.text == "stop_signal") {
      command->stop_signal = Number("a signal's number, 1..64", 1, 64);
    } else if (name.text == "stop_time_allowed") {
      command->stop_time_allowed = Number("seconds, 0..3600", 0, 3600);
    } else {
      Fail(name, "unknown attribute \"" + name.text +
                     "\"; known: exec, deputy, host, auto_respawn, stop_signal, stop_time_allowed");
    }
    Sign(";");
  }

  void Script() {
    const Token name = Take(Token::Kind::kText, "the script's name in quotes");
    if (deployment_.FindScript(name.text) != nullptr)
      Fail(name, "there is a script \"" + name.text + "\" already");
    ProcmanScript script{name.text, {}};
    Sign("{");
    while (!TakeSign("}")) script.steps.push_back(Step());
    deployment_.scripts.push_back(std::move(script));
  }

  ScriptStep Step() {
    ScriptStep step;
    const Token action = Take(Token::Kind::kWord, "start, stop, restart, wait or run_script");
    if (action.text == "run_script") {
      step.kind = ScriptStep::Kind::kRunScript;
      step.target = Take(Token::Kind::kText, "a script's name in quotes").text;
    } else if (action.text == "wait" && Peek().text == "ms") {
      ++at_;
      step.kind = ScriptStep::Kind::kWaitMs;
      step.wait_ms = Number("milliseconds, 0..3600000", 0, 3'600'000);
    } else if (action.text == "wait") {
      step.kind = ScriptStep::Kind::kWaitStatus;
      Target(&step);
      const Token word = Take(Token::Kind::kWord, "status");
      if (word.text != "status") Fail(word, "status is expected, not " + word.text);
      step.wait = Status();
    } else {
      if (action.text != "start" && action.text != "stop" && action.text != "restart") {
        Fail(action, "start, stop, restart, wait or run_script is expected, not " + action.text);
      }
      step.kind = action.text == "start"  ? ScriptStep::Kind::kStart
                  : action.text == "stop" ? ScriptStep::Kind::kStop
                                          : ScriptStep::Kind::kRestart;
      Target(&step);
      if (Peek().text == "wait" && Peek().kind == Token::Kind::kWord) {
        ++at_;
        step.wait = Status();
      }
    }
    Sign(";");
    return step;
  }

  void Target(ScriptStep* step) {
    const Token what = Take(Token::Kind::kWord, "cmd or group");
    if (what.text != "cmd" && what.text != "group") Fail(what, "cmd or group is expected, not " + what.text);
    step->whole_group = what.text == "group";
    step->target = Take(Token::Kind::kText, "an id in quotes").text;
  }

  std::string Status() {
    const Token status = Take(Token::Kind::kText, "\"running\" or \"stopped\"");
    if (status.text != "running" && status.text != "stopped")
      Fail(status, "the status is \"running\" or \"stopped\"");
    return status.text;
  }

  const Token& Peek() const { return tokens_[at_]; }

  Token Take(Token::Kind kind, const std::string& expected) {
    const Token token = tokens_[at_];
    if (token.kind != kind) Fail(token, expected + " is expected, not " + token.text);
    ++at_;
    return token;
  }

  int Number(const std::string& expected, int least, int most) {
    const Token token = Take(Token::Kind::kNumber, expected);
    if (token.text.size() > 8) Fail(token, expected + " is expected, not " + token.text);
    const int value = std::stoi(token.text);
    if (value < least || value > most) Fail(token, expected + " is expected, not " + token.text);
    return value;
  }

  void Sign(const char* sign) {
    if (!TakeSign(sign)) Fail(Peek(), std::string("'") + sign + "' is expected, not " + Peek().text);
  }
  bool TakeSign(const char* sign) {
    if (Peek().kind != Token::Kind::kSign || Peek().text != sign) return false;
    ++at_;
    return true;
  }

  [[noreturn]] void Fail(const Token& token, const std::string& what) const {
    throw std::runtime_error(file_ + ":" + std::to_string(token.line) + ": " + what);
  }

  const std::string& file_;
  std::vector<Token> tokens_;  // the last one is kEnd, which nothing takes
  std::size_t at_ = 0;
  Deployment deployment_;
};

// Every target exists, and no script runs itself, directly or through others.
class ScriptChecker {
 public:
  ScriptChecker(const Deployment& deployment, const std::string& file)
      : deployment_(deployment), file_(file) {}

  void Check(const ProcmanScript& script) {
    if (std::find(path_.begin(), path_.end(), script.name) != path_.end()) Fail(script, "runs itself");
    if (std::find(checked_.begin(), checked_.end(), script.name) != checked_.end()) return;
    path_.push_back(script.name);
    for (const ScriptStep& step : script.steps) CheckStep(script, step);
    path_.pop_back();
    checked_.push_back(script.name);
  }

 private:
  void CheckStep(const ProcmanScript& script, const ScriptStep& step) {
    if (step.kind == ScriptStep::Kind::kWaitMs) return;
    if (step.kind == ScriptStep::Kind::kRunScript) {
      const ProcmanScript* inner = deployment_.FindScript(step.target);
      if (inner == nullptr) Fail(script, "runs script \"" + step.target + "\", which does not exist");
      Check(*inner);
    } else if (step.whole_group ? deployment_.Targets(step).empty()
                                : deployment_.Find(step.target) == nullptr) {
      Fail(script, std::string("means ") + (step.whole_group ? "group" : "command") + " \"" + step.target +
                       "\", which does not exist");
    }
  }

  [[noreturn]] void Fail(const ProcmanScript& script, const std::string& what) const {
    throw std::runtime_error(file_ + ": script \"" + script.name + "\" " + what);
  }

  const Deployment& deployment_;
  const std::string& file_;
  std::vector<std::string> path_, checked_;
};

}  // namespace

Deployment ParseDeployment(const std::string& text, const std::string& file) {
  Deployment deployment = Parser(text, file).Run();
  ScriptChecker checker(deployment, file);
  for (const ProcmanScript& script : deployment.scripts) checker.Check(script);
  return deployment;
}

Deployment LoadDeployment(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw std::runtime_error(path + ": cannot be read; expected a procman file such as procman/evit.procman");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  return ParseDeployment(text, path);
}

}  // namespace evit::procman
