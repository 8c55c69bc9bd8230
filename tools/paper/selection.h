#pragma once

#include <string>
#include <vector>

#include "tools/paper/paper_results.h"

namespace evit::paper {

/// Which runs `--only` words ask for: tables ("I" or "normal", ...), sequences, methods (id, or name for all
/// of that name). Words of one kind add up, kinds narrow each other: "II EVIT" is EVIT on the fast sequences.
class Selection {
 public:
  /// Throws std::runtime_error, listing what there is, for a word that is none of these.
  Selection(const paper::Paper& config, const std::vector<std::string>& words);

  bool Wants(const paper::Sequence& sequence, const paper::Method& method) const;

 private:
  const paper::Paper& config_;
  std::vector<PaperTable> tables_;
  std::vector<std::string> sequences_, methods_;
};

}  // namespace evit::paper
