#pragma once

#include <string>
#include <vector>

namespace evit::diagnosis {

enum class Severity { kGood, kWarning, kError };

/// What one check says of a recording, its calibration or its map.
struct Finding {
  std::string check;   // a stable name, e.g. "imu-unit"
  Severity severity;   // kError: tracking cannot work like this; kWarning: it may suffer
  std::string figure;  // what was measured, for a person: "mean specific force 0.99"
  std::string what;    // in a sentence, what is wrong; empty where it is good
  std::string remedy;  // what to do about it: a command, where there is one
};
using Findings = std::vector<Finding>;

/// Worst first; of equal ones the more basic cause, which is the order they were found in.
void SortBySeverity(Findings* findings);

/// Takes away what is good by one check and wrong by another of the same name, which sees more.
void DropContradicted(Findings* findings);

Finding Good(std::string check, std::string figure);

}  // namespace evit::diagnosis
