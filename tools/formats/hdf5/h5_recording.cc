#include "tools/formats/hdf5/h5_recording.h"

#include <cstdio>
#include <stdexcept>

#include "tools/formats/hdf5/h5_streams.h"
#include "tools/formats/import/event_filter.h"

namespace evit::formats {
namespace {

class H5Events : public EventSource {
 public:
  H5Events(const H5File& file, const H5EventLayout& layout, int width, int height)
      : name_(file.path() + ": " + layout.t), reader_(file, layout), filter_(width, height) {}

  bool Read(EventArray* events) override {
    while (reader_.Read(events)) {
      filter_.Apply(events);
      if (events->size() > 0) return true;
    }
    return false;
  }
  double share() const override { return reader_.share(); }
  std::string name() const override { return name_; }
  DropCounts dropped() const override {
    DropCounts dropped = filter_.dropped();
    dropped.invalid += reader_.n_invalid();
    return dropped;
  }

 private:
  std::string name_;
  H5EventReader reader_;
  EventFilter filter_;
};

// The one asked for, the only one, or the left one.
H5EventLayout Choose(const std::vector<H5EventLayout>& layouts, const std::string& requested,
                     const std::string& path) {
  std::string names;
  std::vector<H5EventLayout> left;
  for (const H5EventLayout& layout : layouts) {
    const std::string group = layout.group.empty() ? "/" : layout.group;
    if (!requested.empty() && (group == requested || group == requested + "/" ||
                               "/" + group == requested + "/" || "/" + group == requested))
      return layout;
    names += (names.empty() ? "" : ", ") + group;
    if (group.find("left") != std::string::npos) left.push_back(layout);
  }
  if (requested.empty() && layouts.size() == 1) return layouts.front();
  if (requested.empty() && left.size() == 1) return left.front();
  throw std::runtime_error(path + ": choose the events to take with --events-topic: " + names);
}

void FindSize(const H5File& file, const H5EventLayout& layout, RecordingInfo* info) {
  if (std::sscanf(file.Attribute("geometry").c_str(), "%dx%d", &info->width, &info->height) == 2) return;
  info->width = info->height = 0;
  const std::string resolution = layout.group + "calib/resolution";
  if (!file.Has(resolution)) return;
  const H5Rows rows = file.Open(resolution);
  if (rows.rows() != 2 || rows.columns() != 1) return;
  const std::vector<double> size = rows.ReadAll<double>();
  if (!(size[0] >= 16 && size[1] >= 16 && size[0] <= 8192 && size[1] <= 8192)) return;
  info->width = static_cast<int>(size[0]);
  info->height = static_cast<int>(size[1]);
}

}  // namespace

H5Recording::H5Recording(const std::vector<std::string>& paths, const std::string& group) {
  std::string datasets;
  bool found = false;
  for (const std::string& path : paths) {
    files_.emplace_back(path);
    const std::vector<H5EventLayout> layouts = FindEvents(files_.back());
    if (layouts.empty()) {
      for (const std::string& name : files_.back().datasets()) {
        if (datasets.size() < 1000) datasets += (datasets.empty() ? "" : ", ") + name;
      }
      continue;
    }
    if (found)
      throw std::runtime_error(path + ": holds events as well as " + files_[events_file_].path() +
                               "; import one recording at a time");
    found = true;
    events_file_ = files_.size() - 1;
    layout_ = Choose(layouts, group, path);
  }
  if (!found) {
    throw std::runtime_error(
        paths.front() +
        ": holds no events (x, y, t, p in one group; rows of t x y p; CD/events); its datasets: " +
        (datasets.empty() ? "none" : datasets));
  }
  constexpr const char* kKinds[] = {"columns ", "rows ", "compounds "};
  info_.format = std::string("HDF5, ") + kKinds[static_cast<int>(layout_.kind)] +
                 (layout_.group.empty() ? "/" : layout_.group);
  FindSize(files_[events_file_], layout_, &info_);
}

std::unique_ptr<EventSource> H5Recording::Events(int width, int height) {
  return std::make_unique<H5Events>(files_[events_file_], layout_, width, height);
}

ImportStreams H5Recording::Streams() {
  ImportStreams streams;
  for (const H5File& file : files_) ReadH5Streams(file, &streams);
  return streams;
}

}  // namespace evit::formats
