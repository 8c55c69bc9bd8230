#include "tools/paper/program_ids.h"

#include "tools/paper/library_ids.h"  // made by the build
#include "tools/paper/text_files.h"

namespace evit::paper {

std::string RecordingProgramId() { return kRecordingLibraries; }

std::string PhotometricProgramId() { return kPhotometricLibraries; }

std::string TrackingProgramId(const std::string& programs) {
  std::string id = kRunLibraries;
  for (const char* name : {"log_replay", "frame_builder", "map_server", "window_optimizer"})
    id += HexText(HashOfFile(programs + "/" + name));
  return HexText(HashOf(id));
}

}  // namespace evit::paper
