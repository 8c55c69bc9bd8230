#include "common/diagnosis/finding.h"

#include <algorithm>
#include <utility>

namespace evit::diagnosis {

void SortBySeverity(Findings* findings) {
  std::stable_sort(findings->begin(), findings->end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
}

Finding Good(std::string check, std::string figure) {
  return {std::move(check), Severity::kGood, std::move(figure), "", ""};
}

}  // namespace evit::diagnosis
