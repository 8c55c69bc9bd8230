#pragma once

#include <optional>
#include <string>
#include <vector>

namespace evit::paper {

/// What `evit paper` is asked for.
struct PaperOptions {
  std::string config;             // config/paper.textproto
  std::string vector;             // VECtor's files; empty: everything is simulated
  std::string out;                // folder of the results
  std::string programs;           // folder of evit and the services
  std::string shared_data;        // folder of recorded motions; empty: none
  std::vector<std::string> only;  // tables, sequences, methods; empty: all
  std::optional<int> seeds;       // in place of the configuration's
  bool quick = false;             // one seed, short clips
  int jobs = 2;                   // run in parallel
};

}  // namespace evit::paper
