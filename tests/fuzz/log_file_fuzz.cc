// LCM logs.
#include <stdexcept>

#include "common/bus/log_file.h"
#include "tests/fuzz/temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const evit::fuzz::TemporaryFile file(data, size);
    const evit::LogReader log(file.path());
    std::vector<std::uint8_t> bytes;
    for (const evit::LogEntry& entry : log.entries()) log.Read(entry, &bytes);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
