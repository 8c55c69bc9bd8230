#include "tools/formats/hdf5/event_file_writer.h"

#include <limits>
#include <stdexcept>

#include "common/files/staged_file.h"
#include "tools/formats/hdf5/h5_handle.h"
#include "tools/formats/hdf5/zstd_filter.h"

namespace evit::formats {
namespace {

constexpr hsize_t kChunk = 1 << 17;  // elements: half a megabyte of stamps
constexpr unsigned kLevel = 1;       // fast; higher levels save few per cent on events

// Of a dataset: HDF5 would note when it was made, and the same events would give another file each time.
H5Handle Undated() {
  H5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), 0);
  return properties;
}

}  // namespace

// One growing, compressed dataset.
class Column {
 public:
  void Create(hid_t file, const char* name, hid_t type, hid_t memory_type) {
    memory_type_ = memory_type;
    const hsize_t none = 0, unlimited = H5S_UNLIMITED;
    const H5Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
    const H5Handle properties = Undated();
    H5Pset_chunk(properties.get(), 1, &kChunk);
    H5Pset_filter(properties.get(), kZstdFilter, H5Z_FLAG_MANDATORY, 1, &kLevel);
    dataset_ = H5Handle(H5Dcreate2(file, name, type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                        H5Dclose);
    if (!dataset_.ok()) throw std::runtime_error(std::string("dataset ") + name + " cannot be made");
  }
  void Append(const void* data, hsize_t n) {
    const hsize_t begin = size_;
    size_ += n;
    if (H5Dset_extent(dataset_.get(), &size_) < 0)
      throw std::runtime_error("a dataset cannot grow: is the disk full?");
    const H5Handle target(H5Dget_space(dataset_.get()), H5Sclose),
        source(H5Screate_simple(1, &n, nullptr), H5Sclose);
    H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, &begin, nullptr, &n, nullptr);
    if (H5Dwrite(dataset_.get(), memory_type_, source.get(), target.get(), H5P_DEFAULT, data) < 0) {
      throw std::runtime_error("writing failed: is the disk full?");
    }
  }
  void Close() { dataset_.Reset(); }

 private:
  H5Handle dataset_;
  hid_t memory_type_ = -1;
  hsize_t size_ = 0;
};

struct EventFileWriter::Impl {
  explicit Impl(const std::string& name) : path(name), staged(name) {}

  std::string path;
  StagedFile staged;  // outlives the file
  Utime t_offset = 0;
  H5Handle file;
  Column x, y, p, t, index;
  std::vector<std::uint32_t> relative;
  std::vector<std::uint64_t> milliseconds;  // ms_to_idx: first event at or after each millisecond
  std::uint64_t count = 0;
  Utime last = std::numeric_limits<Utime>::min();
};

EventFileWriter::EventFileWriter(const std::string& path, Utime t_offset)
    : impl_(std::make_unique<Impl>(path)) {
  RegisterZstdFilter();
  Impl& w = *impl_;
  w.t_offset = t_offset;
  w.file = H5Handle(H5Fcreate(w.staged.part().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (!w.file.ok())
    throw std::runtime_error(path + ": cannot be written; check that the folder exists and is writable");
  const H5Handle group(H5Gcreate2(w.file.get(), "events", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  w.x.Create(w.file.get(), "events/x", H5T_STD_U16LE, H5T_NATIVE_UINT16);
  w.y.Create(w.file.get(), "events/y", H5T_STD_U16LE, H5T_NATIVE_UINT16);
  w.p.Create(w.file.get(), "events/p", H5T_STD_U8LE, H5T_NATIVE_UINT8);
  w.t.Create(w.file.get(), "events/t", H5T_STD_U32LE, H5T_NATIVE_UINT32);
  w.index.Create(w.file.get(), "ms_to_idx", H5T_STD_U64LE, H5T_NATIVE_UINT64);
  const hsize_t one = 1;
  const H5Handle space(H5Screate_simple(1, &one, nullptr), H5Sclose);
  const H5Handle offset(H5Dcreate2(w.file.get(), "t_offset", H5T_STD_I64LE, space.get(), H5P_DEFAULT,
                                   Undated().get(), H5P_DEFAULT),
                        H5Dclose);
  H5Dwrite(offset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &t_offset);
}

EventFileWriter::~EventFileWriter() = default;

void EventFileWriter::Append(const EventArray& events) {
  Impl& w = *impl_;
  if (events.size() == 0) return;
  w.relative.clear();
  for (const Utime t : events.t) {
    const Utime r = t - w.t_offset;
    if (t < w.last || r < 0 || r > std::numeric_limits<std::uint32_t>::max()) {
      throw std::runtime_error(w.path + ": events/t: event " + std::to_string(w.count + w.relative.size()) +
                               " is out of order or outside the 71 minutes after t_offset");
    }
    w.last = t;
    const std::uint64_t index = w.count + w.relative.size();
    while (static_cast<Utime>(w.milliseconds.size()) * 1000 <= r) w.milliseconds.push_back(index);
    w.relative.push_back(static_cast<std::uint32_t>(r));
  }
  try {
    w.x.Append(events.x.data(), events.size());
    w.y.Append(events.y.data(), events.size());
    w.p.Append(events.p.data(), events.size());
    w.t.Append(w.relative.data(), events.size());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(w.path + ": " + error.what());
  }
  w.count += events.size();
}

void EventFileWriter::Close() {
  Impl& w = *impl_;
  w.milliseconds.push_back(w.count);
  w.index.Append(w.milliseconds.data(), w.milliseconds.size());
  for (Column* column : {&w.x, &w.y, &w.p, &w.t, &w.index}) column->Close();
  if (H5Fflush(w.file.get(), H5F_SCOPE_GLOBAL) < 0) throw std::runtime_error(w.path + ": writing failed");
  w.file.Reset();
  w.staged.Commit();
}

}  // namespace evit::formats
