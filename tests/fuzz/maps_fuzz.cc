// Map files: PCD, PLY and text, whichever the bytes look like.
#include <stdexcept>

#include "common/map/map_file.h"
#include "tests/fuzz/temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const evit::fuzz::TemporaryFile file(data, size);
    evit::Summarize(evit::LoadMap(file.path()).map);
  } catch (const std::runtime_error&) {  // the documented answer to a bad file
  }
  return 0;
}
