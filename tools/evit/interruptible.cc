#include "tools/evit/interruptible.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>

#include "common/service/stop_signals.h"
#include "tools/terminal/progress_bar.h"

namespace evit::commands {

void RunUntilSignal(const std::string& command,
                    const std::function<void(const std::function<void()>& check)>& work) {
  const StopSignals signals;
  try {
    work([&signals] {
      if (signals.received()) throw std::runtime_error("interrupted");
    });
  } catch (const std::runtime_error&) {
    if (!signals.received()) throw;
    std::fprintf(stderr, "%s: interrupted; nothing was written\n", command.c_str());
    throw CLI::RuntimeError(130);
  }
}

void RunInterruptibly(const std::string& command, const std::string& doing,
                      const std::function<void(const std::function<void(double)>& report)>& work) {
  RunUntilSignal(command, [&](const auto& check) {
    terminal::ProgressBar bar(doing);
    work([&](double share) {
      check();
      bar.Show(share);
    });
  });
}

}  // namespace evit::commands
