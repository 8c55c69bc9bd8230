#pragma once

#include <string>

namespace CLI {
class App;
}

namespace evit::commands {

/// What a file holds, told by its begin. kForeign: a recording, a picture, an archive; kBinary: none of
/// these, and no text; kOther: not to be told. Readers say more.
enum class Contents { kOther, kLog, kCloud, kRig, kSettings, kTable, kForeign, kBinary };

/// Of a regular file that can be read; of anything else (a pipe) kOther.
Contents ContentsOf(const std::string& path);

/// Looks at the files that the options of a command name (--log, --map, --rig, --truth, ...) before its work
/// begins, so that a missing file, a folder, an empty file, one that may not be read, or one of another kind
/// is said at once, with the option's name and the remedy. Of all commands below `app` but the imports, which
/// recognise files themselves. Also of options that are numbers: they have to be there,
/// finite, and not below zero where they count.
void CheckInputs(CLI::App* app);

/// The check of one file: throws std::runtime_error. `option`: as typed, "--map", or what a file given
/// without one is ("LOG"). Options that are not known, and empty names, pass.
void RequireInput(const std::string& option, const std::string& path);

}  // namespace evit::commands
