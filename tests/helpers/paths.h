#pragma once

#include <string>

namespace evit::test {

/// `relative` to the top folder of the sources, e.g. "config/tracker.textproto".
std::string SourcePath(const std::string& relative);

/// A program that was built with the tests, e.g. "evit"; of "", the folder of all.
std::string ProgramPath(const std::string& name);

/// The folder `name` of the real recordings, which are below EVIT_SHARED_DATA or, if that is not set, in
/// ../shared/data beside the sources. It need not exist.
std::string RecordingsPath(const std::string& name);

}  // namespace evit::test
