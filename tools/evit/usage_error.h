#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace evit::commands {

/// Says on stderr what is wrong with a command line: all options that are missing and all words that are not
/// known, with the known option or command that is nearest, where CLI11 would name the first; or the value
/// that cannot be taken. Help that was asked for goes to stdout. Returns the exit code.
int SayUsageError(const CLI::App& app, const CLI::ParseError& error);

/// The command that was chosen, as it is typed: "evit map build".
std::string CommandName(const CLI::App& app);

/// What to say of a word that is none of the program's commands, with the one that may be meant.
std::string UnknownCommand(const CLI::App& app, const std::string& word);

}  // namespace evit::commands
