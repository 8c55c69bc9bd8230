#include "common/service/help_layout.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>

namespace evit {
namespace {

constexpr std::size_t kDescription = 30;  // the column of descriptions, CLI11's
constexpr char kExample[] = "Example: ";

// Where the text that follows a broken line begins.
std::size_t Indent(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin != 2) return begin;  // all but a name with its description
  const bool described =
      line.size() > kDescription && line[kDescription - 1] == ' ' && line[kDescription] != ' ';
  return described ? kDescription : begin;
}

// Whether a line is a command to be typed, and the column in which it begins.
bool IsCommand(const std::string& line, std::size_t* begin) {
  *begin = line.rfind(kExample, 0) == 0 ? sizeof kExample - 1 : line.find_first_not_of(' ');
  return line.compare(*begin, 5, "evit ") == 0 && line.find(" --", *begin) != std::string::npos &&
         *begin == sizeof kExample - 1;
}

// Appends the line in pieces, each but the last with `mark` at its end and each but the first behind `indent`
// blanks. `gap`: what to break before.
void Break(std::string line, const std::string& gap, std::size_t indent, const std::string& mark,
           std::string* out) {
  const std::string margin(indent, ' ');
  while (line.size() > kHelpColumns) {
    const std::size_t at = line.rfind(gap, kHelpColumns - mark.size());
    // A word that is longer than a line stays whole.
    if (at == std::string::npos || line.find_first_not_of(' ') >= at || at <= indent) break;
    out->append(line, 0, at).append(mark).append("\n");
    line.replace(0, line.find_first_not_of(' ', at), margin);
  }
  out->append(line).append("\n");
}

class Layout : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return WrapHelp(CLI::Formatter::make_help(app, std::move(name), mode));
  }
};

}  // namespace

std::string WrapHelp(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    std::size_t begin = 0;
    if (line.size() <= kHelpColumns) {
      out.append(line).append("\n");
    } else if (IsCommand(line, &begin)) {
      Break(line, " --", begin + 4, " \\", &out);
    } else {
      Break(line, " ", Indent(line), "", &out);
    }
  }
  return out;
}

void LayOutHelp(CLI::App* app) { app->formatter(std::make_shared<Layout>()); }

}  // namespace evit
