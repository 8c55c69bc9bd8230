// Map files: PCD, PLY and text, whichever the bytes look like, and each as a photometric map too.
#include <stdexcept>

#include "common/map/map_file.h"
#include "common/map/photometric_map.h"
#include "tests/fuzz/temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const evit::fuzz::TemporaryFile file(data, size);
  try {
    evit::Summarize(evit::LoadMap(file.path()).map);
  } catch (const std::runtime_error&) {  // the documented answer to a bad file
  }
  try {
    evit::LoadPhotometricMap(file.path());
  } catch (const std::runtime_error&) {
  }
  return 0;
}
