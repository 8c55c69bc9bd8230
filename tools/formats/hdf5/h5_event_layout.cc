#include <algorithm>
#include <map>

#include "tools/formats/hdf5/h5_events.h"

namespace evit::formats {
namespace {

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// The dataset of a group with one of these names; empty: none.
std::string AnyOf(const std::map<std::string, std::string>& members, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto found = members.find(name);
    if (found != members.end()) return found->second;
  }
  return "";
}

}  // namespace

std::vector<H5EventLayout> FindEvents(const H5File& file) {
  std::vector<H5EventLayout> found;
  std::map<std::string, std::map<std::string, std::string>> groups;  // group/ to names in it to datasets
  for (const std::string& dataset : file.datasets()) {
    const std::size_t slash = dataset.rfind('/');
    const std::string group = slash == std::string::npos ? "" : dataset.substr(0, slash + 1);
    groups[group][dataset.substr(group.size())] = dataset;
  }
  for (const auto& [group, members] : groups) {
    H5EventLayout layout;
    layout.group = group;
    layout.x = AnyOf(members, {"x", "xs"});
    layout.y = AnyOf(members, {"y", "ys"});
    layout.t = AnyOf(members, {"t", "ts", "timestamps"});
    layout.p = AnyOf(members, {"p", "ps", "pol", "polarity"});
    if (layout.x.empty() || layout.y.empty() || layout.t.empty() || layout.p.empty()) continue;
    const std::size_t slash = group.empty() ? std::string::npos : group.rfind('/', group.size() - 2);
    const std::string parent = slash == std::string::npos ? "" : group.substr(0, slash + 1);
    for (const std::string& name : {group + "t_offset", parent + "t_offset"}) {
      if (file.Has(name)) layout.offset = name;
    }
    found.push_back(layout);
  }
  for (const std::string& dataset : file.datasets()) {
    H5EventLayout layout;
    layout.t = dataset;
    layout.group = dataset;
    if (dataset == "CD/events") {
      layout.kind = H5EventLayout::Kind::kCompound;
    } else if (dataset == "events" || EndsWith(dataset, "/events")) {
      const H5Rows rows = file.Open(dataset);
      layout.kind = rows.is_compound() ? H5EventLayout::Kind::kCompound : H5EventLayout::Kind::kRows;
      if (!rows.is_compound() && rows.columns() != 4) continue;
    } else {
      continue;
    }
    found.push_back(layout);
  }
  return found;
}

}  // namespace evit::formats
