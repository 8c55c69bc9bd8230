#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace evit::procman {

/// A command line taken apart.
struct CommandLine {
  std::vector<std::pair<std::string, std::string>> environment;  // NAME=VALUE words before the program
  std::vector<std::string> words;                                // program and arguments, at least one
};

/// Value of an environment variable, where it is set.
using Variables = std::function<std::optional<std::string>(const std::string&)>;

/// Splits like a POSIX shell: spaces, 'single' and "double" quotes, backslash, $NAME and ${NAME} (not in
/// single quotes; outside double quotes its value is split at spaces). No shell is started: pipes, ; and >
/// have no meaning. Throws std::runtime_error where a quote is open, a variable is not set or there is no
/// program.
CommandLine SplitCommandLine(const std::string& line, const Variables& variables);

/// With this process's environment.
CommandLine SplitCommandLine(const std::string& line);

/// The other way: words quoted so that SplitCommandLine gives them back.
std::string JoinCommandLine(const std::vector<std::string>& words);

}  // namespace evit::procman
