#pragma once

#include <string>
#include <vector>

/// Looks at the names of outputs before the work begins. Each throws std::runtime_error naming the option.
namespace evit::commands {

/// A file that can be written: its folder exists and takes a new file (tried with one that is removed at
/// once), and what may be there already is a file. Of an empty name nothing is asked: there is no such
/// output.
void RequireOutput(const std::string& option, const std::string& path);

/// The same of a log: what is there already is a log as well, so that a recording is not lost by a slip.
void RequireLogOutput(const std::string& option, const std::string& path);

/// A folder that is there and can be written to, or can be made. Of an empty name nothing is asked.
void RequireOutputFolder(const std::string& option, const std::string& path);

/// `path` is none of these files, which are read or written too. Empty names are passed over.
void RequireNotAnInput(const std::string& option, const std::string& path,
                       const std::vector<std::string>& inputs);

}  // namespace evit::commands
