// VECtor's HDF5 event files.
#include <stdexcept>

#include "tests/fuzz/temporary_file.h"
#include "tools/formats/vector/event_file_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const evit::fuzz::TemporaryFile file(data, size);
    evit::formats::EventFileReader reader(file.path());
    evit::EventArray events;
    for (int k = 0; k < 10 && reader.Read(10'000, &events) > 0; ++k) {
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
