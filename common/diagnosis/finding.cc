#include "common/diagnosis/finding.h"

#include <algorithm>
#include <set>
#include <utility>

namespace evit::diagnosis {

void SortBySeverity(Findings* findings) {
  std::stable_sort(findings->begin(), findings->end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
}

void DropContradicted(Findings* findings) {
  std::set<std::string> wrong;
  for (const Finding& f : *findings)
    if (f.severity != Severity::kGood) wrong.insert(f.check);
  findings->erase(std::remove_if(findings->begin(), findings->end(),
                                 [&](const Finding& f) {
                                   return f.severity == Severity::kGood && wrong.count(f.check) > 0;
                                 }),
                  findings->end());
}

Finding Good(std::string check, std::string figure) {
  return {std::move(check), Severity::kGood, std::move(figure), "", ""};
}

}  // namespace evit::diagnosis
