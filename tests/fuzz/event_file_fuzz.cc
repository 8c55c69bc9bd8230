// Event files in HDF5: layouts and filters are ours, the container is the library's.
#include <stdexcept>

#include "tests/fuzz/temporary_file.h"
#include "tools/formats/hdf5/h5_recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const evit::fuzz::TemporaryFile file(data, size);
    evit::formats::H5Recording recording({file.path()}, "");
    recording.Streams();
    const auto events = recording.Events(640, 480);
    evit::EventArray piece;
    for (int k = 0; k < 10 && events->Read(&piece); ++k) {
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
