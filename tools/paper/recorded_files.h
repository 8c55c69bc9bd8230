#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/paper/paper_config.h"

namespace evit::paper {

/// A recorded sequence's files.
struct RecordedFiles {
  std::string folder;             // of VECtor's own files
  std::vector<std::string> bags;  // or these
  std::string map;                // empty: it is to be made of the pictures
  std::string pictures;           // of the left regular camera: folder, archive or bag, where there is no map
  std::string photometric_map;    // empty: there is none
};
/// Nothing where the sequence is not below `folder` (in it, or in a folder of the sequence's name).
std::optional<RecordedFiles> FindRecorded(const std::string& folder, const paper::Sequence& sequence);

}  // namespace evit::paper
