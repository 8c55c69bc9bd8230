#pragma once

#include <functional>
#include <string>

namespace evit::commands {

/// Does `work`, which reports its share (0..1) now and then, and shows that as "`doing`: ...". After Ctrl-C,
/// SIGTERM or SIGHUP the next report throws, so that all that was begun is taken away on the way out; then
/// "COMMAND: interrupted; nothing was written" is said, and CLI::RuntimeError(130) thrown.
void RunInterruptibly(const std::string& command, const std::string& doing,
                      const std::function<void(const std::function<void(double)>& report)>& work);

/// The same without a bar: `work` is given what throws after such a signal, to be called now and then.
void RunUntilSignal(const std::string& command,
                    const std::function<void(const std::function<void()>& check)>& work);

}  // namespace evit::commands
