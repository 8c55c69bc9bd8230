#include "tools/formats/vector/h5_column.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/formats/vector/h5_chunk.h"

namespace evit::formats {
namespace {

constexpr double kMaxWhole = 9e15;  // a double holds whole numbers up to here

// Debian's package with the plug-in for a filter, for the remedy; empty where there is none.
std::string PackageOf(H5Z_filter_t filter) {
  switch (filter) {
    case 32001:
      return "Blosc, apt install hdf5-filter-plugin-blosc-serial";
    case 307:
      return "BZip2, apt install hdf5-filter-plugin";
    case 32004:
      return "LZ4, apt install hdf5-filter-plugin";
    case 32008:
      return "Bitshuffle, apt install hdf5-filter-plugin";
    case 32013:
      return "ZFP, apt install hdf5-filter-plugin-zfp-serial";
    default:
      return "not known here";
  }
}

}  // namespace

H5Column::H5Column(hid_t file, const std::string& path, const std::string& name, const std::string& layout)
    : path_(path), name_(name), dataset_(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose) {
  if (!dataset_.ok()) Fail("is missing; expected " + layout);
  const H5Handle space(H5Dget_space(dataset_.get()), H5Sclose);
  size_ = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  if (H5Sget_simple_extent_ndims(space.get()) > 1) Fail("has several dimensions; expected " + layout);
  H5Handle type(H5Dget_type(dataset_.get()), H5Tclose);
  if (H5Tget_class(type.get()) == H5T_ENUM)
    type = H5Handle(H5Tget_super(type.get()), H5Tclose);  // h5py's bool
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT)
    Fail("holds no numbers (text, or a compound); expected " + layout);
  class_ = kind == H5T_FLOAT ? Class::kFloat : Class::kInteger;
  unsigned_ = kind == H5T_INTEGER && H5Tget_sign(type.get()) == H5T_SGN_NONE;
  bytes_ = H5Tget_size(type.get());
  RequireFilters();
}

void H5Column::RequireFilters() const {
  const H5Handle properties(H5Dget_create_plist(dataset_.get()), H5Pclose);
  for (int k = 0; k < H5Pget_nfilters(properties.get()); ++k) {
    unsigned flags = 0;
    std::size_t n_values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(properties.get(), static_cast<unsigned>(k), &flags, &n_values,
                                               nullptr, 0, nullptr, nullptr);
    if (filter < 0 || H5Zfilter_avail(filter) > 0) continue;
    Fail("is compressed with a filter that HDF5 has no plug-in for here (" + std::to_string(filter) + ": " +
         PackageOf(filter) +
         "); install it, or repack the file where it is known: h5repack -f GZIP=4 IN OUT");
  }
}

void H5Column::ReadAs(hid_t type, std::size_t begin, std::size_t n, void* out) const {
  const hsize_t first = begin, count = n;
  const H5Handle source(H5Dget_space(dataset_.get()), H5Sclose),
      target(H5Screate_simple(1, &count, nullptr), H5Sclose);
  herr_t selected = 0;
  if (H5Sget_simple_extent_ndims(source.get()) == 1)
    selected = H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, &first, nullptr, &count, nullptr);
  if (selected < 0 || ReadChunks(dataset_.get(), type, target.get(), source.get(), out) < 0)
    Fail("cannot be read at entry " + std::to_string(begin) + ": the file is damaged; download it again");
}

void H5Column::Read(std::size_t begin, std::size_t n, std::vector<double>* out) const {
  out->resize(n);
  if (n > 0) ReadAs(H5T_NATIVE_DOUBLE, begin, n, out->data());
}

void H5Column::Read(std::size_t begin, std::size_t n, const std::string& what,
                    std::vector<std::int64_t>* out) const {
  out->resize(n);
  if (n == 0) return;
  if (class_ == Class::kInteger) {
    // Through uint64, whose conversion to int64 would clip: -1 stored unsigned in eight bytes is -1 again.
    ReadAs(unsigned_ ? H5T_NATIVE_UINT64 : H5T_NATIVE_INT64, begin, n, out->data());
    return;
  }
  std::vector<double> values;
  Read(begin, n, &values);
  for (std::size_t k = 0; k < n; ++k) {
    if (!(std::abs(values[k]) < kMaxWhole) || values[k] != std::floor(values[k]))
      Fail("entry " + std::to_string(begin + k) + " is " + std::to_string(values[k]) + ": " + what);
    (*out)[k] = static_cast<std::int64_t>(values[k]);
  }
}

void H5Column::Fail(const std::string& what) const {
  throw std::runtime_error(path_ + ": dataset " + name_ + " " + what);
}

}  // namespace evit::formats
