#include "tests/helpers/doctor_faults.h"

#include <algorithm>

namespace evit::doctor {

using diagnosis::Finding;
using diagnosis::Severity;

std::vector<Fault> Faults() {
  std::vector<Fault> all = EventFaults();
  for (const std::vector<Fault>& more : {ImuFaults(), PlaceFaults()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

bool IsNamed(const std::vector<std::string>& checks, const diagnosis::Findings& findings, std::string* said) {
  bool named = false;
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const Finding& f = findings[k];
    if (f.severity == Severity::kGood) continue;
    *said += f.check + ": " + f.what + " (" + f.figure + ")\n";
    named = named || (k < 2 && std::find(checks.begin(), checks.end(), f.check) != checks.end());
  }
  return named;
}

bool IsNamed(const Fault& fault, const diagnosis::Findings& findings, std::string* said) {
  return IsNamed(std::vector<std::string>{fault.check}, findings, said);
}

}  // namespace evit::doctor
