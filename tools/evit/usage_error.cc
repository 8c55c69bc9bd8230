#include "tools/evit/usage_error.h"

#include <cstdio>
#include <string>
#include <vector>

#include "common/text/edit_distance.h"

namespace evit::commands {
namespace {

constexpr std::size_t kNear = 3;  // letters that a known option may differ by to be meant

// The command that was given: `evit map build`, say.
const CLI::App& Chosen(const CLI::App& app) {
  const CLI::App* chosen = &app;
  while (!chosen->get_subcommands().empty()) chosen = chosen->get_subcommands().front();
  return *chosen;
}

// As it is typed: "evit map build".
std::string FullName(const CLI::App& app) {
  std::string name = "evit";
  for (const CLI::App* chosen = &app; !chosen->get_subcommands().empty();) {
    chosen = chosen->get_subcommands().front();
    name += " " + chosen->get_name();
  }
  return name;
}

std::string Missing(const CLI::App& command) {
  std::string names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_required() && option->count() == 0)
      names.append(names.empty() ? "" : ", ").append(option->get_name());
  }
  return names;
}

std::string Nearest(const CLI::App& command, const std::string& word) {
  std::string nearest;
  std::size_t least = kNear + 1;
  for (const CLI::Option* option : command.get_options()) {
    const std::size_t distance = EditDistance(option->get_name(), word);
    if (distance >= least) continue;
    least = distance;
    nearest = option->get_name();
  }
  return nearest;
}

std::string Unknown(const CLI::App& command) {
  std::string words;
  for (const std::string& word : command.remaining()) {
    words.append(words.empty() ? "" : ", ").append(word);
    const std::string nearest = word.rfind("--", 0) == 0 ? Nearest(command, word) : "";
    if (!nearest.empty()) words += " (did you mean " + nearest + "?)";
  }
  return words;
}

}  // namespace

int SayUsageError(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = Chosen(app);
  const bool incomplete = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                          dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string missing = Missing(command), unknown = Unknown(command);
  if (incomplete && missing.empty() && unknown.empty()) {  // a command of commands by itself
    std::fputs(command.help().c_str(), stderr);
    return error.get_exit_code();
  }
  if (!incomplete) return app.exit(error);
  const std::string name = FullName(app);
  if (!unknown.empty()) {
    std::fprintf(stderr, "%s: error: not understood: %s\n", name.c_str(), unknown.c_str());
    if (unknown.front() != '-')
      std::fprintf(stderr, "  a file needs its option before it, and a value with blanks quotes around it\n");
  }
  if (!missing.empty()) std::fprintf(stderr, "%s: error: missing: %s\n", name.c_str(), missing.c_str());
  std::fprintf(stderr, "%s --help says more\n", name.c_str());
  return error.get_exit_code();
}

}  // namespace evit::commands
