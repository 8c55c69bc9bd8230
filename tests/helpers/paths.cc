#include "tests/helpers/paths.h"

#include <cstdlib>

namespace evit::test {

std::string SourcePath(const std::string& relative) { return EVIT_SOURCE_DIR "/" + relative; }

std::string ProgramPath(const std::string& name) { return EVIT_BIN_DIR "/" + name; }

std::string RecordingsPath(const std::string& name) {
  const char* const shared = std::getenv("EVIT_SHARED_DATA");
  return (shared != nullptr ? std::string(shared) : SourcePath("../shared/data")) + "/" + name;
}

}  // namespace evit::test
