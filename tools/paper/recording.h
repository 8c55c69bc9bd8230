#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/paper/paper_config.h"
#include "tools/paper/paper_job.h"

namespace evit::paper {

/// One sequence to track, as it will lie on disk: recorded, or simulated in one of several rooms.
struct Recording {
  const paper::Sequence* sequence = nullptr;
  int seed = 1;                      // room; 1 where recorded
  std::string name;                  // e.g. "sofa_fast.10s.1", "sofa_fast.recorded"
  std::string source;                // for people: what it is
  double seconds = 40;               // its length; recorded whole sequences: about
  std::string log, map, truth, rig;  // files, once `job` is done
  PaperJob job;
  std::string photometric_map;  // empty: there is none
  std::optional<PaperJob>
      photometric_job;  // makes it, from what `job` leaves; nothing where it is there already
};

struct RecordingOptions {
  std::string vector;       // folder of VECtor's files; empty: all is simulated
  std::string shared_data;  // folder of recorded motions; empty: none
  std::string work;         // folder to make recordings in
  double seconds = 10;      // of simulated ones
  int seeds = 3;
  int threads = 1;  // of one simulation
};

/// All recordings of a sequence: the one in options.vector, or simulated ones. Throws std::runtime_error,
/// naming files and remedy, where a recorded sequence lacks its map or ground truth.
std::vector<Recording> RecordingsOf(const paper::Paper& config, const paper::Sequence& sequence,
                                    const RecordingOptions& options);

}  // namespace evit::paper
