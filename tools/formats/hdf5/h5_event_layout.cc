#include "tools/formats/hdf5/h5_event_layout.h"

#include <algorithm>
#include <map>

#include "common/text/words.h"
#include "tools/formats/hdf5/h5_sample.h"
#include "tools/formats/import/event_columns.h"

namespace evit::formats {
namespace {

// The dataset of a group with one of these names; empty: none.
std::string AnyOf(const std::map<std::string, std::string>& members, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto found = members.find(name);
    if (found != members.end()) return found->second;
  }
  return "";
}

// Names in lower case, as they stand in a group or in compounds, to what they mean; false: no events.
bool FindColumns(const std::map<std::string, std::string>& members, H5EventLayout* layout) {
  layout->x = AnyOf(members, {"x", "xs"});
  layout->y = AnyOf(members, {"y", "ys"});
  layout->t = AnyOf(members, {"t", "ts", "timestamps", "timestamp", "time"});
  layout->p = AnyOf(members, {"p", "ps", "pol", "polarity", "polarities"});
  return !layout->x.empty() && !layout->y.empty() && !layout->t.empty() && !layout->p.empty();
}

// What Prophesee's files hold can be read at once; others member by member. EXT_TRIGGER/events has no pixels.
bool FindMembers(const H5File& file, const H5Rows& rows, H5EventLayout* layout) {
  std::map<std::string, std::string> members;
  for (const std::string& name : rows.members()) members[name] = rows.name() + ":" + name;
  if (!FindColumns(members, layout)) return false;
  const bool usual = members.count("x") + members.count("y") + members.count("p") + members.count("t") == 4 &&
                     file.Open(layout->t).is_integer() && file.Open(layout->p).is_signed() &&
                     file.Open(layout->x).bytes() <= 2 && file.Open(layout->y).bytes() <= 2 &&
                     !file.Open(layout->x).is_signed();
  if (!usual) return true;
  *layout = {};
  layout->kind = H5EventLayout::Kind::kCompound;
  layout->t = rows.name();
  return true;
}

// Rows of four numbers are events' where their values can be (or their name says so: the reader tells what is
// wrong).
bool IsTableOfEvents(const H5Rows& rows) {
  if (rows.name() == "events" || EndsWith(rows.name(), "/events")) return true;
  if (!rows.is_number() || rows.rows() < 10) return false;
  return FitsEvents(SampleColumns({&rows}, ""));
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
    if (!FindColumns(members, &layout)) continue;
    const std::size_t slash = group.empty() ? std::string::npos : group.rfind('/', group.size() - 2);
    const std::string parent = slash == std::string::npos ? "" : group.substr(0, slash + 1);
    for (const std::string& name : {group + "t_offset", parent + "t_offset"}) {
      if (file.Has(name)) layout.offset = name;
    }
    found.push_back(layout);
  }
  for (const std::string& dataset : file.datasets()) {
    const H5Rows rows = file.Open(dataset);
    H5EventLayout layout;
    if (rows.is_compound()) {
      if (rows.columns() != 1 || !FindMembers(file, rows, &layout)) continue;
    } else if (rows.columns() == 4 && IsTableOfEvents(rows)) {
      layout.kind = H5EventLayout::Kind::kRows;
      layout.t = dataset;
    } else {
      continue;
    }
    layout.group = dataset;
    found.push_back(layout);
  }
  return found;
}

}  // namespace evit::formats
