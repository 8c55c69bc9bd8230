#include "tools/formats/vector/event_file_reader.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tools/formats/vector/h5_handle.h"
#include "tools/formats/vector/zstd_filter.h"

namespace evit::formats {

struct EventFileReader::Impl {
  std::string path;
  H5Handle file, x, y, p, t;
  std::size_t size = 0, at = 0;
  std::int64_t t_offset = 0;
  std::int64_t last = 0;
  std::vector<std::int64_t> stamps;

  [[noreturn]] void Fail(const std::string& what) const { throw std::runtime_error(path + ": " + what); }

  H5Handle Open(const char* name) const {
    H5Handle dataset(H5Dopen2(file.get(), name, H5P_DEFAULT), H5Dclose);
    if (!dataset.ok()) {
      Fail(std::string("dataset ") + name +
           " is missing; VECtor's layout is events/{x,y,p,t}, t_offset, ms_to_idx");
    }
    return dataset;
  }

  static hsize_t Length(const H5Handle& dataset) {
    const H5Handle space(H5Dget_space(dataset.get()), H5Sclose);
    return static_cast<hsize_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  }

  void ReadPart(const H5Handle& dataset, const char* name, hid_t type, hsize_t n, void* out) const {
    const hsize_t begin = at;
    const H5Handle source(H5Dget_space(dataset.get()), H5Sclose),
        target(H5Screate_simple(1, &n, nullptr), H5Sclose);
    H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, &begin, nullptr, &n, nullptr);
    if (H5Dread(dataset.get(), type, target.get(), source.get(), H5P_DEFAULT, out) < 0) {
      Fail(std::string("dataset ") + name + " cannot be read at event " + std::to_string(at) +
           ": the file is damaged, or compressed with a filter other than Zstandard (32015); download it "
           "again");
    }
  }
};

EventFileReader::EventFileReader(const std::string& path) : impl_(std::make_unique<Impl>()) {
  RegisterZstdFilter();
  Impl& r = *impl_;
  r.path = path;
  if (!std::filesystem::exists(path)) r.Fail("there is no such file");
  r.file = H5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!r.file.ok()) r.Fail("is not a complete HDF5 file (truncated or damaged); download it again");
  r.x = r.Open("events/x");
  r.y = r.Open("events/y");
  r.p = r.Open("events/p");
  r.t = r.Open("events/t");
  const H5Handle offset = r.Open("t_offset");
  if (Impl::Length(offset) != 1 ||
      H5Dread(offset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &r.t_offset) < 0) {
    r.Fail("dataset t_offset: expected one integer (us)");
  }
  r.size = Impl::Length(r.t);
  for (const auto& [dataset, name] : {std::pair(&r.x, "x"), std::pair(&r.y, "y"), std::pair(&r.p, "p")}) {
    if (Impl::Length(*dataset) != r.size) {
      r.Fail(std::string("events/") + name + " has " + std::to_string(Impl::Length(*dataset)) +
             " entries, events/t " + std::to_string(r.size) + ": the file is damaged; download it again");
    }
  }
}

EventFileReader::~EventFileReader() = default;

std::size_t EventFileReader::size() const { return impl_->size; }

std::size_t EventFileReader::Read(std::size_t max_events, EventArray* events) {
  Impl& r = *impl_;
  events->clear();
  const std::size_t n = std::min(max_events, r.size - r.at);
  if (n == 0) return 0;
  events->t.resize(n);
  events->x.resize(n);
  events->y.resize(n);
  events->p.resize(n);
  r.ReadPart(r.x, "events/x", H5T_NATIVE_UINT16, n, events->x.data());
  r.ReadPart(r.y, "events/y", H5T_NATIVE_UINT16, n, events->y.data());
  r.ReadPart(r.p, "events/p", H5T_NATIVE_UINT8, n, events->p.data());
  r.ReadPart(r.t, "events/t", H5T_NATIVE_INT64, n, events->t.data());
  for (std::size_t k = 0; k < n; ++k) {
    events->p[k] = events->p[k] != 0 ? 1 : 0;
    if (events->t[k] < r.last) {
      r.Fail("events/t: event " + std::to_string(r.at + k) + " is earlier (" + std::to_string(events->t[k]) +
             " us) than the one before (" + std::to_string(r.last) + " us): events must be sorted by time");
    }
    r.last = events->t[k];
    events->t[k] += r.t_offset;
  }
  r.at += n;
  return n;
}

}  // namespace evit::formats
