#pragma once

#include <CLI/CLI.hpp>

namespace evit::commands {

/// Says on stderr what is wrong with a command line: all options that are missing and all words that are not
/// known, with the known option that is nearest, where CLI11 would name the first. Help that was asked for
/// goes to stdout. Returns the exit code.
int SayUsageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace evit::commands
