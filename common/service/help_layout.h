#pragma once

#include <cstddef>
#include <string>

namespace CLI {
class App;
}

namespace evit {

inline constexpr std::size_t kHelpColumns = 100;

/// A help text with lines of at most kHelpColumns columns, where its words allow. What continues a line stays
/// in its column: that of an option's description, or the line's own begin. A command that is too long is
/// broken before an option, with a backslash, so that it can still be pasted.
std::string WrapHelp(const std::string& text);

/// Makes the help of a program such a text. Before subcommands are added, which take it over.
void LayOutHelp(CLI::App* app);

}  // namespace evit
