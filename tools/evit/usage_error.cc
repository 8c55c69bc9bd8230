#include "tools/evit/usage_error.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "common/text/edit_distance.h"

namespace evit::commands {
namespace {

constexpr std::size_t kNear = 3;  // letters that a known name may differ by to be meant, at most

// The command that was given: `evit map build`, say.
const CLI::App& Chosen(const CLI::App& app) {
  const CLI::App* chosen = &app;
  while (!chosen->get_subcommands().empty()) chosen = chosen->get_subcommands().front();
  return *chosen;
}

std::string Missing(const CLI::App& command) {
  std::string names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_required() && option->count() == 0)
      names.append(names.empty() ? "" : ", ").append(option->get_name());
  }
  return names;
}

// A third of the letters, and few of them, may be wrong.
bool IsNear(std::size_t distance, const std::string& word) {
  return distance <= std::min(kNear, (word.size() + 2) / 3);
}

// Of names, the one that is most like a word; empty where none is.
std::string Nearest(const std::vector<std::string>& names, const std::string& word) {
  std::string nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& name : names) {
    const std::size_t distance = EditDistance(name, word);
    if (distance >= least || !IsNear(distance, word)) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

std::vector<std::string> CommandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::string Unknown(const CLI::App& command) {
  std::vector<std::string> options;
  for (const CLI::Option* option : command.get_options()) options.push_back(option->get_name());
  const std::vector<std::string> commands = CommandsOf(command);
  std::string words;
  for (const std::string& word : command.remaining()) {
    words.append(words.empty() ? "" : ", ").append(word);
    const std::string nearest = Nearest(word.rfind("--", 0) == 0 ? options : commands, word);
    if (!nearest.empty()) words += " (did you mean " + nearest + "?)";
  }
  return words;
}

// What a number of a type has to be.
std::string KindOf(const std::string& type) {
  if (type.rfind("FLOAT", 0) == 0) return "a number";
  if (type.rfind("UINT", 0) == 0) return "a whole number from 0 on";
  return type.rfind("INT", 0) == 0 ? "a whole number" : "a value";
}

std::string Number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// Of "Value V not in range A to B", whose numbers CLI11 writes with all their digits, up to three hundred:
// the same for a reader. Empty where it is something else.
std::string OutOfRange(const CLI::Option& option, const std::string& what) {
  const std::string& name = option.get_name();
  const std::string begin = name + ": Value ", middle = " not in range ", between = " to ";
  const std::size_t at = what.find(middle), to = what.rfind(between);
  if (what.rfind(begin, 0) != 0 || at == std::string::npos || to == std::string::npos || to < at) return "";
  const double low = std::strtod(what.c_str() + at + middle.size(), nullptr);
  const double high = std::strtod(what.c_str() + to + between.size(), nullptr);
  const std::string type = option.get_type_name();
  std::string range = type.rfind("FLOAT", 0) == 0 ? "a number " : "a whole number ";
  if (high < 1e18) {
    range += "from " + Number(low) + " to " + Number(high);
  } else {  // no limit but the type's
    range += type.find("POSITIVE") != std::string::npos ? "above 0" : "from " + Number(low) + " on";
  }
  std::string text = name + ": '";
  return text.append(what, begin.size(), at - begin.size()).append("' is not ").append(range);
}

// CLI11's words for a value that it cannot take, in ours where they say little.
std::string WrongValue(const CLI::App& command, const CLI::ParseError& error) {
  std::string what = error.what();
  for (const CLI::Option* option : command.get_options()) {
    const std::string& name = option->get_name();
    if (std::string text = OutOfRange(*option, what); !text.empty()) return text;
    std::string said = name;
    const std::string unread = "Could not convert: " + name + " = ";
    if (what.rfind(unread, 0) == 0)
      return said.append(": '")
          .append(what, unread.size())
          .append("' is not ")
          .append(KindOf(option->get_type_name()));
    if (what.rfind(said.append(": "), 0) != 0 ||
        dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr)
      continue;
    if (option->count() > 1)
      return said.append("given ").append(std::to_string(option->count())).append(" times; give it once");
    return said.append(KindOf(option->get_type_name())).append(" is missing after it");
  }
  return what;
}

}  // namespace

std::string CommandName(const CLI::App& app) {
  std::string name = "evit";
  for (const CLI::App* chosen = &app; !chosen->get_subcommands().empty();) {
    chosen = chosen->get_subcommands().front();
    name += " " + chosen->get_name();
  }
  return name;
}

std::string UnknownCommand(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = CommandsOf(app);
  const std::string nearest = Nearest(names, word);
  std::string text = "there is no command \"" + word + "\"" +
                     (nearest.empty() ? "" : " (did you mean evit " + nearest + "?)") + "; known: ";
  for (std::size_t k = 0; k < names.size(); ++k) text.append(k == 0 ? "" : ", ").append(names[k]);
  return text;
}

int SayUsageError(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = Chosen(app);
  const bool incomplete = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                          dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string missing = Missing(command), unknown = Unknown(command);
  if (incomplete && missing.empty() && unknown.empty()) {  // a command of commands by itself
    std::fputs(command.help().c_str(), stderr);
    return error.get_exit_code();
  }
  const std::string name = CommandName(app);
  if (!incomplete) {
    if (error.get_exit_code() == 0 || dynamic_cast<const CLI::RuntimeError*>(&error) != nullptr)
      return app.exit(error);
    std::fprintf(stderr, "%s: error: %s\n", name.c_str(), WrongValue(command, error).c_str());
    return error.get_exit_code();
  }
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
