#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/run/child.h"

namespace evit {

/// One service to start: its name, which is its program's too, and its arguments.
struct ServiceCommand {
  std::string name;
  std::vector<std::string> arguments;
  bool replaceable = false;  // keeps nothing that a run needs: is started again when it dies
};

/// The services of one run as child processes. They end with this object.
class Pipeline {
 public:
  /// Starts `services` in their order. `programs`: folder of the executables; `logs`: folder for NAME.log,
  /// what each one says. Throws std::runtime_error where one cannot be started.
  Pipeline(const std::vector<ServiceCommand>& services, const std::string& programs, const std::string& logs);

  /// Call often. Starts a dead replaceable service again. Throws std::runtime_error, with its last words,
  /// where another one has died or a replaceable one dies at every start.
  void Watch();

  /// SIGINT to each, the last one started first: the sources go before those who wait for them.
  void Stop();

  /// How often a replaceable service was started again.
  int restarts() const { return restarts_; }
  const std::vector<std::unique_ptr<Child>>& children() const { return children_; }

 private:
  std::vector<ServiceCommand> services_;
  std::vector<std::unique_ptr<Child>> children_;
  int restarts_ = 0;
};

}  // namespace evit
