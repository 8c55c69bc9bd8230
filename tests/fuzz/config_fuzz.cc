// Rig and tracker files. The first byte chooses.
#include <stdexcept>

#include "common/config/config.h"
#include "tests/fuzz/temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    const evit::fuzz::TemporaryFile file(data + 1, size - 1);
    data[0] % 2 == 0 ? static_cast<void>(evit::LoadRig(file.path()))
                     : static_cast<void>(evit::LoadTracker(file.path()));
  } catch (const std::runtime_error&) {
  }
  return 0;
}
